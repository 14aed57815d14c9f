// Cells of surface that looks alike: near each other, facing the same way, reflecting about the same colour. Functions
// without bindings.
#ifndef PATINA_LIB_SURFACE_CELLS_GLSL
#define PATINA_LIB_SURFACE_CELLS_GLSL
#include "lib/math/mean.glsl"
#include "lib/records/reflectance.glsl"
#include "shared/reflectance/surface_albedo.h"

// Where a record lies among the cells. A cell's middle is at whole numbers.
struct SurfacePlace {
    vec4 at;    // cells: position, brightness
    vec2 tint;  // cells
    uint side;  // that the normal faces
};

// `reflected`: what the surface reflects diffusely, linear pixel values.
SurfacePlace surface_place(vec3 point_m, vec3 normal, vec3 reflected) {
    const vec3 size = abs(normal);
    const uint axis = size.x >= max(size.y, size.z) ? 0u : size.y >= size.z ? 1u : 2u;
    const uint side = 2u * axis + (normal[axis] < 0.0 ? 1u : 0u);
    const vec3 logs = log(reflected + kSurfaceDarkest);
    return SurfacePlace(vec4(point_m / kSurfaceCellM, mean_of(logs) / kSurfaceBrightness),
                        (logs.rb - logs.g) / kSurfaceTint, side);
}

uint tint_word(ivec2 tint) { return (uint(tint.x) & 31u) | (uint(tint.y) & 31u) << 5; }

// Never 0. Cells 164 m apart are one.
uint surface_key(ivec4 cell, ivec2 tint, uint side) {
    const uvec3 low = uvec3(cell.xyz) & 1023u;
    const uint where = low.x | low.y << 10 | low.z << 20;
    const uint what = side | tint_word(tint) << 3 | (uint(cell.w) & 63u) << 13;
    return max(hash_of_key(where ^ hash_of_key(what)), 1u);
}

// Of all of a segment that has a tint.
uint segment_tint_key(uint label, ivec2 tint) {
    return max(hash_of_key(label ^ hash_of_key(tint_word(tint) | 0x80000000u)), 1u);
}

// Of all that faces one side, whatever it looks like.
uint light_key(ivec3 cell, uint side) { return surface_key(ivec4(cell, 0), ivec2(0), side | 0x80000000u); }

uint surface_cell_place(uint key, uint probe) { return (hash_of_key(key) + probe) & (kSurfaceCells - 1u); }

#endif
