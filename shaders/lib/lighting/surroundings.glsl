// Where a cell of the surroundings lies in their table. Functions without bindings.
#ifndef PATINA_LIB_SURROUNDINGS_GLSL
#define PATINA_LIB_SURROUNDINGS_GLSL
#include "lib/map/voxel_map.glsl"
#include "shared/reflectance/surroundings.h"

// 10 bits of each coordinate, so that cells 51 m apart are one; never 0.
uint surroundings_key(ivec3 cell) {
    const uvec3 low = uvec3(cell) & 1023u;
    return low.x | low.y << 10 | low.z << 20 | 0x80000000u;
}

ivec3 surroundings_cell(vec3 point_m) { return ivec3(floor(point_m / kSurroundingsCellM)); }

uint surroundings_place(uint key, uint probe) { return (hash_of_key(key) + probe) & (kSurroundingsCells - 1u); }

vec3 mean_of_sums(SurroundingsSums sums) {
    return vec3(sums.r, sums.g, sums.b) / (float(max(sums.samples, 1u)) * kSurroundingsSteps);
}

// What was seen at low exposure counts where the usual exposure shows nothing, or too bright a colour.
vec3 mean_radiance(SurroundingsLight light) {
    const vec3 usual = mean_of_sums(light.usual);
    const bool bright = max(max(usual.r, usual.g), usual.b) > kNearlyClipped;
    return light.low.samples > 0u && (bright || light.usual.samples == 0u) ? mean_of_sums(light.low) : usual;
}

uint samples_of(SurroundingsLight light) { return light.usual.samples + light.low.samples; }

#endif
