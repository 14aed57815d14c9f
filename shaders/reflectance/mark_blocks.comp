#version 460
#extension GL_GOOGLE_include_directive : require
// Marks the blocks of the map.
#include "lib/map/occupancy.glsl"
#include "lib/map/voxel_map.glsl"
#include "shared/reflectance/far_field.h"
#include "shared/reflectance/surroundings.h"

layout(local_size_x = kMarkBlocksGroup) in;
layout(std430, binding = 0) readonly buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 1) readonly buffer Counters { MapCounters counters; };
layout(std430, binding = 2) buffer Surroundings{SURROUNDINGS_MEMBERS};
layout(push_constant) uniform Push { VoxelGrid grid; };

void main() {
    const uint block = gl_GlobalInvocationID.x;
    if (block >= counters.high_water) return;
    const uint key = block_keys[block];
    if (key != kEmptyKey) MARK_CELL(blocks_in_use, block_of_key(grid, key))
}
