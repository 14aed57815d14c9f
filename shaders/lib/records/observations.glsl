// Packing of observations and of voxel records (shared/observation/observations.h). Functions without bindings.
#ifndef PATINA_LIB_OBSERVATIONS_GLSL
#define PATINA_LIB_OBSERVATIONS_GLSL
#include "lib/math/octahedral.glsl"
#include "shared/observation/observations.h"

const float kSameFaceCosine = 0.5;  // 60 degrees: of normals of one face, within a voxel or beside each other

uint pack_clipped(bvec3 clipped) { return uint(clipped.r) << 26 | uint(clipped.g) << 27 | uint(clipped.b) << 28; }

// A direction word: octahedral 13 + 13 bits (0.02 degrees) | clipped channels 3 | samples - 1, 3.
uint pack_direction(vec3 direction, bvec3 clipped, uint samples) {
    const ivec2 at = ivec2(round(to_octahedral(direction) * 4095.0));
    return (uint(at.x) & 0x1fffu) | (uint(at.y) & 0x1fffu) << 13 | pack_clipped(clipped) | (samples - 1u) << 29;
}
vec3 observation_direction(uint word) {
    return from_octahedral(vec2(int(word << 19) >> 19, int(word << 6) >> 19) * (1.0 / 4095.0));
}
bvec3 observation_clipped(uint word) { return notEqual(uvec3(word) >> uvec3(26u, 27u, 28u) & 1u, uvec3(0u)); }
uint observation_samples(uint word) { return (word >> 29) + 1u; }

// Directions are compared on a grid: whole numbers below 2^24 make float arithmetic exact, so that which pair of
// observations is the closest is the same in every shader and on every device.
vec3 direction_on_grid(uint word) { return round(observation_direction(word) * kDirectionSteps); }
const float kFarApart = 3.0e7;  // above every squared distance on the grid
float grid_distance2(vec3 a, vec3 b) {
    const vec3 d = a - b;
    return dot(d, d);
}

// Linear colours with a shared exponent: 9 bits each, 5 of exponent (VK_FORMAT_E5B9G9R9_UFLOAT_PACK32).
uint pack_shared_exponent(vec3 rgb) {
    const vec3 c = clamp(rgb, 0.0, 65408.0);
    const float most = max(max(c.r, c.g), c.b);
    int exponent = max(int(floatBitsToUint(most) >> 23) - 127, -16) + 16;
    // Rounding may carry into the tenth bit.
    if (floor(most * uintBitsToFloat(uint(24 - exponent + 127) << 23) + 0.5) > 511.0) ++exponent;
    const uvec3 m = uvec3(floor(c * uintBitsToFloat(uint(24 - exponent + 127) << 23) + 0.5));
    return m.r | m.g << 9 | m.b << 18 | uint(exponent) << 27;
}
vec3 unpack_shared_exponent(uint word) {
    return vec3(word & 0x1ffu, word >> 9 & 0x1ffu, word >> 18 & 0x1ffu) *
           uintBitsToFloat(((word >> 27) + 127u - 24u) << 23);
}

// Fields of a VoxelRecord.
uint observation_count(VoxelRecord record) { return record.state & 0x1fu; }
uint voxel_in_block(VoxelRecord record) { return record.state >> 5 & 0x3fu; }
uint surface_samples(VoxelRecord record) { return record.state >> 11 & 0x1fu; }
uint record_label(VoxelRecord record) { return record.label & 0xffffu; }
uint label_confidence(VoxelRecord record) { return record.label >> 16 & 0xffu; }
vec3 surface_normal(VoxelRecord record) {
    return from_octahedral(vec2(int(record.normal << 16) >> 16, int(record.normal) >> 16) * (1.0 / 32767.0));
}
// Along the normal from the voxel's centre to the surface, in voxels.
float surface_offset_vox(VoxelRecord record) { return float(int(record.state) >> 16) * (1.0 / 32767.0); }

uint pack_normal(vec3 normal) {
    const ivec2 at = ivec2(round(to_octahedral(normal) * 32767.0));
    return (uint(at.x) & 0xffffu) | uint(at.y) << 16;
}
uint pack_state(uint count, uint voxel, uint samples, float offset_vox) {
    return count | voxel << 5 | samples << 11 | uint(int(round(clamp(offset_vox, -1.0, 1.0) * 32767.0))) << 16;
}

// A voxel's coordinates, and its centre in metres.
ivec3 voxel_of_record(ivec3 block, uint voxel, uint edge_shift) {
    const uint mask = (1u << edge_shift) - 1u;
    return (block << edge_shift) + ivec3(voxel & mask, voxel >> edge_shift & mask, voxel >> 2u * edge_shift);
}
uint voxel_number(ivec3 voxel, uint edge_shift) {
    const uvec3 within = uvec3(voxel) & ((1u << edge_shift) - 1u);
    return within.x | within.y << edge_shift | within.z << 2u * edge_shift;
}

#endif
