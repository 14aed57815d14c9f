#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup per new key: pops a block from the free list, clears its voxels, and enters it in the table; or leaves
// the key without a block when it was not among those accepted.
#include "lib/map/accepted_key.glsl"
#include "lib/map/voxel_chunks.glsl"
#include "lib/map/voxel_map.glsl"
#include "shared/fusion/allocate_blocks.h"

layout(local_size_x = kAssignGroup) in;
layout(std430, binding = 0) readonly buffer Keys { uint keys[]; };
layout(std430, binding = 1) readonly buffer NewSlots { uint new_slots[]; };
layout(std430, binding = 2) readonly buffer FreeList { uint free_list[]; };
layout(std430, binding = 3) buffer Counters { MapCounters counters; };
layout(std430, binding = 4) buffer Blocks { uint blocks[]; };
layout(std430, binding = 5) buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 6) buffer Tsdf { uvec4 quads[]; }
tsdf[kMaxVoxelChunks];
layout(std430, binding = 12) buffer Color { uvec4 quads[]; }
color[kMaxVoxelChunks];
layout(push_constant) uniform Push { VoxelGrid grid; };

shared uint block;

void claim(uint slot) {
    const uint key = keys[slot];
    block = kNoBlock;
    if (is_accepted(hash_of_key(key), counters.accepted_bins)) {
        block = free_list[counters.claim_base - 1u - atomicAdd(counters.claimed, 1u)];
        block_keys[block] = key;
    }
    blocks[slot] = block;
}

void main() {
    const uint item = group_item(gl_WorkGroupID);
    if (item >= counters.assign_keys) return;
    if (gl_LocalInvocationIndex == 0u) claim(new_slots[item]);
    barrier();
    if (block == kNoBlock) return;
    const uint first = index_in_chunk(grid.chunk_shift, block) * (kBlockVoxels / 4u);
#define CLEAR(C)                                                                       \
    for (uint i = gl_LocalInvocationIndex; i < kBlockVoxels / 4u; i += kAssignGroup) { \
        tsdf[C].quads[first + i] = uvec4(0u);                                          \
        color[C].quads[first + i] = uvec4(0u);                                         \
    }
    WITH_CHUNK(grid.chunk_shift, block, CLEAR)
}
