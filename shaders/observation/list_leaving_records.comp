#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the blocks that leave and their records, side by side, and gives back the places of both. Records stay as they
// are until these are taken again, which passes do after those that copy them.
#include "shared/observation/stream_records.h"

layout(local_size_x = kLeaveGroup) in;
layout(std430, binding = 0) readonly buffer Leaving { uint leaving[]; };
layout(std430, binding = 1) readonly buffer RecordTable { uint record_table[]; };
layout(std430, binding = 2) buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 3) writeonly buffer FreeBlocks { uint free_blocks[]; };
layout(std430, binding = 4) writeonly buffer FreeRecords { uint free_records[]; };
layout(std430, binding = 5) buffer BlockCounters { MapCounters blocks; };
layout(std430, binding = 6) buffer RecordCounters { MapCounters counted; };
layout(std430, binding = 7) writeonly buffer Streamed { StreamedBlock streamed[]; };
layout(std430, binding = 8) writeonly buffer StreamedRecords { uint streamed_records[]; };
layout(std430, binding = 9) buffer Count { LeavingCount count; };
layout(push_constant) uniform Push { LeaveRecordsParams params; };
#include "lib/records/leaving_records.glsl"

void main() {
    const uint block = gl_GlobalInvocationID.x;
    if (block >= blocks.high_water) return;
    const uint key = block_keys[block];
    if (!is_outside(key) || !is_accepted(hash_of_key(key), leaving[kLeavingAccepted])) return;

    block_keys[block] = kEmptyKey;
    free_blocks[atomicAdd(blocks.free_blocks, 1u)] = block;
    atomicAdd(blocks.left_blocks, 1u);
    const uint records = records_of(block);
    if (records == 0u) return;  // the next who sees it inserts it again
    uint listed = atomicAdd(count.records, records);
    uint freed = atomicAdd(counted.free_blocks, records);
    atomicAdd(counted.left_blocks, records);
    streamed[atomicAdd(count.blocks, 1u)] = StreamedBlock(key, block, 0u, 0u, listed, records);
    const uint voxels = 1u << 3u * params.edge_shift;
    for (uint i = 0u; i < voxels; ++i) {
        const uint record = record_table[block * voxels + i];
        if (record >= kNewRecord) continue;
        streamed_records[listed++] = record;
        free_records[freed++] = record;
    }
}
