#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation per block of observed voxels that comes back: takes a place for it, if there are places for its
// records and for those of the blocks before it in the list, and enters its key in the table.
#include "lib/map/voxel_map.glsl"
#include "shared/observation/stream_records.h"

layout(local_size_x = kLeaveGroup) in;
layout(std430, binding = 0) coherent buffer Keys { uint keys[]; };
layout(std430, binding = 1) buffer Blocks { uint blocks[]; };
layout(std430, binding = 2) buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 3) readonly buffer FreeList { uint free_list[]; };
layout(std430, binding = 4) buffer Counters { MapCounters counters; };
layout(std430, binding = 5) buffer Streamed { StreamedBlock streamed[]; };
layout(std430, binding = 6) buffer RecordCounters { MapCounters counted; };
layout(std430, binding = 7) buffer Returned { ReturnedCount returned; };
layout(std430, binding = 8) writeonly buffer RecordTable { uvec4 record_table[]; };
layout(push_constant) uniform Push { ReturnRecordsParams params; };
#define RETURN_GRID params.records
#include "fusion/return_main.glsl"
#include "shared/observation/observations.h"

void main() {
    const uint item = gl_GlobalInvocationID.x;
    if (item >= params.block_count) return;
    const uint end = streamed[item].first_record + streamed[item].records;
    if (end > counted.free_blocks) {
        streamed[item].block = kNoBlock;
        atomicAdd(counted.refused_blocks, streamed[item].records);
        return;
    }
    return_block(item);
    atomicMax(returned.claimed, end);
    if (streamed[item].fresh == 0u) {
        atomicAdd(returned.unused, streamed[item].records);
        return;
    }
    const uint quads = 1u << 3u * params.edge_shift >> 2u, first = streamed[item].block * quads;
    for (uint i = 0u; i < quads; ++i) record_table[first + i] = uvec4(kNoRecord);
}
