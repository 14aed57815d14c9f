// What decides whether a record's visibility and albedo are up to date (shared/reflectance/reflectance.h), and the
// packing of the albedo. Functions without bindings.
#ifndef PATINA_LIB_REFLECTANCE_GLSL
#define PATINA_LIB_REFLECTANCE_GLSL
#include "lib/map/voxel_map.glsl"
#include "lib/records/observations.glsl"
#include "shared/reflectance/reflectance.h"

// Where the surface passes a record's voxel: from the centre along the normal.
vec3 surface_point_m(VoxelRecord record, VoxelGrid grid, uint edge_shift) {
    const ivec3 block = block_of_key(grid, record.block_key);
    const vec3 center_vox = vec3(voxel_of_record(block, voxel_in_block(record), edge_shift)) + 0.5;
    return (center_vox + surface_normal(record) * surface_offset_vox(record)) * grid.voxel_m;
}

// A record's surface, coarsely, with the version of the lights' positions: octahedral normal 8 + 8 bits | offset 8 |
// version 8, never 0.
uint marched_word(VoxelRecord record, uint position_version) {
    const ivec2 normal = ivec2(round(to_octahedral(surface_normal(record)) * 127.0));
    const int offset = int(round(surface_offset_vox(record) * 127.0));
    return (uint(normal.x) & 0xffu) | (uint(normal.y) & 0xffu) << 8 | (uint(offset) & 0xffu) << 16 |
           (position_version % 255u + 1u) << 24;
}
// Lights were marched at their present positions.
bool is_marched(uint word, uint position_version) { return word >> 24 == position_version % 255u + 1u; }
// So they were, and from about where the surface is now.
bool is_marched_from(uint word, VoxelRecord record, uint position_version) {
    const vec3 normal = from_octahedral(vec2(int(word << 24) >> 24, int(word << 16) >> 24) * (1.0 / 127.0));
    const float offset = float(int(word << 8) >> 24) * (1.0 / 127.0);
    return is_marched(word, position_version) && dot(normal, surface_normal(record)) > 0.995 &&  // 6 degrees
           abs(offset - surface_offset_vox(record)) < 0.15;
}

// Whether light i is in a record's visibility.
bool bit_is_set(uvec2 bits, uint i) { return ((i < 32u ? bits.x >> i : bits.y >> (i - 32u)) & 1u) != 0u; }

// The versions that an albedo was computed with. Never 0, as lights' versions are not.
uint refined_word(uint lights_version, uint material_version) {
    return max(lights_version & 0xffffu, 1u) | material_version << 16;
}

// How sure a channel of the albedo is, three times 10 bits; 0: unknown.
uint pack_certainty(vec3 certainty) {
    const uvec3 c = uvec3(round(clamp(certainty, 0.0, 1.0) * 1023.0));
    return c.r | c.g << 10 | c.b << 20;
}
vec3 albedo_certainty(uvec2 albedo) {
    return vec3(albedo.y & 0x3ffu, albedo.y >> 10 & 0x3ffu, albedo.y >> 20 & 0x3ffu) * (1.0 / 1023.0);
}
// What the light explains, up to kMostRawKd, and what can be.
vec3 albedo_raw_kd(uvec2 albedo) { return unpack_shared_exponent(albedo.x); }
vec3 albedo_kd(uvec2 albedo) { return min(albedo_raw_kd(albedo), 1.0); }

// A segment's kd; a is 0 where too few of its records know it.
vec4 segment_kd(SegmentAlbedo segment) {
    const vec3 weight = vec3(segment.weight.rgb);
    const bool known = min(min(weight.r, weight.g), weight.b) >= kLeastSegmentWeight * kCertaintySteps;
    return known ? vec4(vec3(segment.kd.rgb) / (weight * kAlbedoSteps), 1.0) : vec4(0.0);
}

#endif
