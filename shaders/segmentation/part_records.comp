#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Gives records of labels that have a partner to that of the two whose colours are theirs, as part_voxels.comp does
// with voxels.
#include "lib/map/voxel_chunks.glsl"
#include "lib/map/voxel_map.glsl"
#include "lib/segments/split_rule.glsl"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer RecordCounters { MapCounters counters; };
layout(std430, binding = 1) buffer Records { VoxelRecord records[]; };
layout(std430, binding = 2) buffer Changed { uint changed[]; };
layout(binding = 3, r32ui) uniform readonly uimageBuffer Parents;
layout(binding = 4, r32ui) uniform readonly uimageBuffer Partners;
layout(std430, binding = 5) readonly buffer Rules { SplitRule rules[]; };
layout(std430, binding = 6) readonly buffer Colors { uvec4 quads[]; }
colors[kMaxVoxelChunks];
layout(push_constant) uniform Push { SplitParams params; };
#include "lib/records/mean_color.glsl"

void main() {
    const uint id = gl_GlobalInvocationID.x;
    if (id >= counters.high_water) return;
    const VoxelRecord record = records[id];
    if (record.block_key == kEmptyKey) return;
    const uint root = imageLoad(Parents, int(record_label(record))).x;
    const uint partner = imageLoad(Partners, int(root)).x;
    if (partner == kNoLabel) return;
    if (!is_partners(rules[root], mean_color(params.grid.chunk_shift, id, observation_count(record)))) return;
    records[id].label = (record.label & ~0xffffu) | partner;
    changed[id] = params.stamp;
}
