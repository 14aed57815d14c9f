#version 460
#extension GL_GOOGLE_include_directive : require
// Copies what else the device has of listed records, counts them as away, and empties their places.
#include "lib/map/voxel_map.glsl"
#include "shared/observation/stream_records.h"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer StreamedRecords { uint streamed_records[]; };
layout(std430, binding = 1) readonly buffer Count { LeavingCount listed; };
layout(std430, binding = 2) buffer Records { VoxelRecord records[]; };
layout(std430, binding = 3) readonly buffer Seen { uint seen[]; };
layout(std430, binding = 4) readonly buffer Changed { uint changed[]; };
layout(std430, binding = 5) readonly buffer Albedo { uvec2 albedo[]; };
layout(std430, binding = 6) readonly buffer Visibility { uvec2 visibility[]; };
layout(std430, binding = 7) buffer Status { RecordStatus status[]; };
layout(std430, binding = 8) buffer Away { SegmentAlbedo away[]; };
layout(std430, binding = 10) buffer Gathered { RecordSurroundings gathered[]; };
layout(std430, binding = 9) writeonly buffer Packed { StreamedRecord packed_records[]; };
layout(push_constant) uniform Push { CopyRecordsParams params; };
#include "lib/records/away_albedo.glsl"

void main() {
    const uint item = gl_GlobalInvocationID.x;
    if (item >= min(listed.records, params.count)) return;
    const uint id = streamed_records[item];
    const VoxelRecord record = records[id];
    packed_records[item] = StreamedRecord(record, seen[id], changed[id], albedo[id], visibility[id], status[id],
                                          gathered[id].around, 0u, 0u, 0u);
    count_away(record.block_key, record, albedo[id], true);
    // As of a record that was given back.
    records[id] = VoxelRecord(kEmptyKey, 0u, 0u, 0u);
    status[id] = RecordStatus(0u, 0u, 0u, 0u, uvec2(0u), uvec2(0u), 0u, 0u);
    gathered[id] = RecordSurroundings(uvec2(0u), 0u, 0u);
}
