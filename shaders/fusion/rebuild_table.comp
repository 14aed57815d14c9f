#version 460
#extension GL_GOOGLE_include_directive : require
// Enters every block in use in the emptied table. Keys that had been refused are left out and may come again.
#include "shared/fusion/allocate_blocks.h"

layout(local_size_x = kAssignGroup) in;
layout(std430, binding = 0) readonly buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 1) coherent buffer Keys { uint keys[]; };
layout(std430, binding = 2) writeonly buffer Blocks { uint blocks[]; };
layout(std430, binding = 3) buffer Counters { MapCounters counters; };
layout(push_constant) uniform Push { VoxelGrid grid; };
#include "lib/map/insert_key.glsl"

void main() {
    const uint block = gl_GlobalInvocationID.x;
    if (block >= counters.high_water) return;
    const uint key = block_keys[block];
    if (key == kEmptyKey) return;
    // Blocks take a quarter of the table at most; that kMaxProbes buckets in a row are full is then as good as
    // impossible.
    const Insertion at = insert_key(grid, key, true);
    if (at.slot == kNoSlot) return;
    blocks[at.slot] = block;
    atomicAdd(counters.table_keys, 1u);
}
