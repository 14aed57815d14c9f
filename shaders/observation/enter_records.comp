#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation per record that comes back: takes its place, writes it there, and enters it in its block's table. It
// counts as away no longer. Where the block was there, its records are newer than those that come back, which are
// dropped.
#include "lib/map/voxel_map.glsl"
#include "lib/records/observations.glsl"
#include "shared/observation/stream_records.h"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer Streamed { StreamedBlock streamed[]; };
layout(std430, binding = 1) readonly buffer Packed { StreamedRecord packed_records[]; };
layout(std430, binding = 2) readonly buffer FreeRecords { uint free_records[]; };
layout(std430, binding = 3) readonly buffer RecordCounters { MapCounters counted; };
layout(std430, binding = 4) writeonly buffer RecordTable { uint record_table[]; };
layout(std430, binding = 5) writeonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 6) writeonly buffer Seen { uint seen[]; };
layout(std430, binding = 7) writeonly buffer Changed { uint changed[]; };
layout(std430, binding = 8) writeonly buffer Albedo { uvec2 albedo[]; };
layout(std430, binding = 9) writeonly buffer Visibility { uvec2 visibility[]; };
layout(std430, binding = 10) writeonly buffer Status { RecordStatus status[]; };
layout(std430, binding = 11) buffer Away { SegmentAlbedo away[]; };
layout(std430, binding = 12) writeonly buffer Entered { uint entered[]; };
layout(std430, binding = 13) writeonly buffer Gathered { RecordSurroundings gathered[]; };
layout(push_constant) uniform Push { ReturnRecordsParams params; };
#include "lib/records/away_albedo.glsl"

void main() {
    const uint item = gl_GlobalInvocationID.x;
    if (item >= params.record_count) return;
    const StreamedRecord came = packed_records[item];
    const StreamedBlock block = streamed[came.record.block_key];
    entered[item] = kNoRecord;
    if (block.block == kNoBlock) return;
    VoxelRecord record = came.record;
    record.block_key = block.key;
    count_away(block.key, record, came.albedo, false);
    if (block.fresh == 0u) return;
    const uint id = free_records[counted.free_blocks - 1u - item];
    record_table[(block.block << 3u * params.edge_shift) + voxel_in_block(record)] = id;
    records[id] = record;
    seen[id] = came.seen;
    changed[id] = came.changed;
    albedo[id] = came.albedo;
    visibility[id] = came.visibility;
    status[id] = came.status;
    gathered[id] = RecordSurroundings(uvec2(0u), came.around, 0u);
    entered[item] = id;
}
