#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation per block that comes back: takes a place for it and enters its key in the table. A key that has a
// block keeps it, and the block's voxels are replaced.
#include "lib/map/voxel_map.glsl"
#include "shared/fusion/stream_blocks.h"

layout(local_size_x = kLeaveGroup) in;
layout(std430, binding = 0) coherent buffer Keys { uint keys[]; };
layout(std430, binding = 1) buffer Blocks { uint blocks[]; };
layout(std430, binding = 2) buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 3) readonly buffer FreeList { uint free_list[]; };
layout(std430, binding = 4) buffer Counters { MapCounters counters; };
layout(std430, binding = 5) buffer Streamed { StreamedBlock streamed[]; };
layout(push_constant) uniform Push { ReturnParams params; };
#include "lib/map/insert_key.glsl"

// A free place, kNoBlock where there is none.
uint take_place() {
    const uint free = atomicAdd(counters.free_blocks, 0xffffffffu);
    if (free - 1u >= params.grid.capacity) {  // also where there was none: the count wraps around
        atomicAdd(counters.free_blocks, 1u);
        return kNoBlock;
    }
    atomicMax(counters.high_water, params.grid.capacity - (free - 1u));
    return free_list[free - 1u];
}

void main() {
    const uint item = gl_GlobalInvocationID.x;
    if (item >= params.count) return;
    const uint key = streamed[item].key;
    const Insertion at = insert_key(params.grid, key, true);
    uint block = kNoBlock;
    if (at.slot != kNoSlot) {
        block = at.fresh ? kNoBlock : blocks[at.slot];
        if (block == kNoBlock) {
            block = take_place();
            blocks[at.slot] = block;
            if (block != kNoBlock) {
                block_keys[block] = key;
                atomicAdd(counters.returned_blocks, 1u);
            }
        }
        if (at.fresh) atomicAdd(counters.table_keys, 1u);
    }
    if (block == kNoBlock) atomicAdd(counters.refused_blocks, 1u);
    streamed[item].block = block;
}
