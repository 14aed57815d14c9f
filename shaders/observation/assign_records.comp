#version 460
#extension GL_GOOGLE_include_directive : require
// Takes a free record for every voxel seen for the first time, empties it and lists it; or marks the voxel as refused
// when it was not among those accepted.
#include "lib/map/accepted_key.glsl"
#include "lib/records/observations.glsl"
#include "lib/records/record_hash.glsl"
#include "lib/records/record_list.glsl"

layout(local_size_x = kRecordGroup) in;
layout(std140, binding = 0) uniform Observation { ObservationParams frame; };
layout(std430, binding = 1) readonly buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 2) readonly buffer NewVoxels { uint new_voxels[]; };
layout(std430, binding = 3) buffer Counters { MapCounters counters; };
layout(std430, binding = 4) buffer RecordTable { uint record_table[]; };
layout(std430, binding = 5) buffer Records { VoxelRecord records[]; };
layout(std430, binding = 6) buffer Seen { uint seen[]; };
layout(std430, binding = 7) buffer Changed { uint changed[]; };
layout(std430, binding = 8) buffer Albedo { uvec2 albedo[]; };
layout(std430, binding = 9) buffer Visibility { uvec2 visibility[]; };
layout(std430, binding = 10) buffer Visible { uint visible[]; };
layout(std430, binding = 11) buffer VisibleArguments { uint visible_arguments[]; };
layout(std430, binding = 12) readonly buffer FreeRecords { uint free_records[]; };

void main() {
    const uint item = gl_GlobalInvocationID.x;
    if (item >= counters.assign_keys) return;
    const uint entry = new_voxels[item];
    const uint shift = 3u * frame.edge_shift;
    const uint key = block_keys[entry >> shift];
    const uint voxel = entry & ((1u << shift) - 1u);
    if (!is_accepted(hash_of_voxel(key, voxel), counters.accepted_bins)) {
        record_table[entry] = kRefusedRecord;
        return;
    }
    const uint record = free_records[counters.claim_base - 1u - atomicAdd(counters.claimed, 1u)];
    record_table[entry] = record;
    records[record] = VoxelRecord(key, 0u, pack_state(0u, voxel, 0u, 0.0), 0u);
    seen[record] = frame.stamp;
    changed[record] = 0u;
    albedo[record] = uvec2(0u);
    visibility[record] = uvec2(0u);
    APPEND_RECORD(visible, visible_arguments, record)
}
