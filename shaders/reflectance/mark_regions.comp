#version 460
#extension GL_GOOGLE_include_directive : require
// Marks the regions that have a block of the map.
#include "lib/map/map_regions.glsl"
#include "lib/map/voxel_map.glsl"

layout(local_size_x = kMarkRegionsGroup) in;
layout(std430, binding = 0) readonly buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 1) readonly buffer Counters { MapCounters counters; };
layout(std430, binding = 2) buffer Surroundings{SURROUNDINGS_MEMBERS};
layout(push_constant) uniform Push { VoxelGrid grid; };

void main() {
    const uint block = gl_GlobalInvocationID.x;
    if (block >= counters.high_water) return;
    const uint key = block_keys[block];
    if (key == kEmptyKey) return;
    const uint bit = bit_of_region(region_of_block(block_of_key(grid, key)));
    const uint mark = 1u << (bit & 31u);
    // Nearly all were marked before.
    if ((map_regions[bit >> 5u] & mark) == 0u) atomicOr(map_regions[bit >> 5u], mark);
}
