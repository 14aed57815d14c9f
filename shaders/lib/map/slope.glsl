// Packing of slopes (shared/fusion/slope.h). Functions without bindings.
#ifndef PATINA_LIB_SLOPE_GLSL
#define PATINA_LIB_SLOPE_GLSL
#include "shared/fusion/slope.h"

// Depth per pixel in x and y (metres, snorm 11 bits each), the cosine between ray and normal times the ray's length at
// z = 1 (unorm 9 bits, at most 1): what a difference of depths times it is the distance from the tangent plane; and
// whether something nearer ends beside the pixel (1 bit).
uint pack_slope(vec2 depth_per_px, float plane_factor, bool beside_edge) {
    const ivec2 s = ivec2(round(clamp(depth_per_px / kMaxSlope, -1.0, 1.0) * 1023.0));
    return (uint(s.x) & 0x7ffu) | (uint(s.y) & 0x7ffu) << 11 |
           uint(round(clamp(plane_factor, 0.0, 1.0) * 511.0)) << 22 | uint(beside_edge) << 31;
}
vec2 slope_depth_per_px(uint slope) {
    return vec2(int(slope << 21) >> 21, int(slope << 10) >> 21) * (kMaxSlope / 1023.0);
}
float slope_plane_factor(uint slope) { return float(slope >> 22 & 0x1ffu) * (1.0 / 511.0); }
bool slope_beside_edge(uint slope) { return slope >> 31 != 0u; }

#endif
