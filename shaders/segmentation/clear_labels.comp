#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup per new key, as in fusion/assign_blocks.comp: clears the labels of the block that it got.
#include "lib/map/voxel_chunks.glsl"
#include "lib/map/voxel_map.glsl"
#include "shared/fusion/allocate_blocks.h"

layout(local_size_x = kAssignGroup) in;
layout(std430, binding = 0) readonly buffer NewSlots { uint new_slots[]; };
layout(std430, binding = 1) readonly buffer Blocks { uint blocks[]; };
layout(std430, binding = 2) readonly buffer Counters { MapCounters counters; };
layout(std430, binding = 3) writeonly buffer Words { uvec4 quads[]; }
words[kMaxVoxelChunks];
layout(std430, binding = 8) writeonly buffer Stamps { uint stamps[]; };
layout(push_constant) uniform Push { VoxelGrid grid; };

void main() {
    const uint item = group_item(gl_WorkGroupID);
    if (item >= counters.assign_keys) return;
    const uint block = blocks[new_slots[item]];
    if (block == kNoBlock) return;
    if (gl_LocalInvocationIndex == 0u) stamps[block] = 0u;
    const uint first = index_in_chunk(grid.chunk_shift, block) * (kBlockVoxels / 4u);
#define CLEAR(C)                                                                     \
    for (uint i = gl_LocalInvocationIndex; i < kBlockVoxels / 4u; i += kAssignGroup) \
        words[C].quads[first + i] = uvec4(0u);
    WITH_CHUNK(grid.chunk_shift, block, CLEAR)
}
