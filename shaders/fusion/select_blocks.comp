#version 460
#extension GL_GOOGLE_include_directive : require
// Decides which of this frame's new keys get a block.
#include "lib/map/voxel_map.glsl"
#include "shared/fusion/allocate_blocks.h"

layout(std430, binding = 0) readonly buffer Keys { uint keys[]; };
layout(std430, binding = 1) readonly buffer NewSlots { uint new_slots[]; };
layout(std430, binding = 2) buffer Counters { MapCounters counters; };
layout(std430, binding = 3) writeonly buffer AssignArguments { uvec4 assign_arguments; };
layout(std430, binding = 4) writeonly buffer BlockArguments { uvec4 block_arguments; };
layout(push_constant) uniform Push { VoxelGrid grid; };
#define HASH(i) hash_of_key(keys[new_slots[i]])
#include "fusion/select_main.glsl"

void main() {
    const uint total = select_keys(grid.capacity);
    if (gl_LocalInvocationIndex != 0u) return;
    assign_arguments = uvec4(kGroupsPerRow, (total + kGroupsPerRow - 1u) / kGroupsPerRow, 1u, 0u);
    block_arguments = uvec4((counters.high_water + kAssignGroup - 1u) / kAssignGroup, 1u, 1u, 0u);
}
