// A frame's surface in camera coordinates (shared/segmentation/find_edges.h). Functions without bindings.
#ifndef PATINA_LIB_FRAME_SURFACE_GLSL
#define PATINA_LIB_FRAME_SURFACE_GLSL
#include "lib/math/octahedral.glsl"
#include "shared/segmentation/find_edges.h"

// Normals in 32 bits, octahedral, 16 bits each from 1 to 65535; 0 stands for none.
uint pack_normal(vec3 normal) {
    const uvec2 bits = uvec2(round(to_octahedral(normal) * 32767.0) + 32768.0);
    return bits.x | bits.y << 16;
}
vec3 unpack_normal(uint packed) { return from_octahedral((vec2(packed & 0xffffu, packed >> 16) - 32768.0) / 32767.0); }

vec3 surface_point_m(FrameSurfaceParams params, ivec2 pixel, float z) {
    return vec3((vec2(pixel) - params.focal_center_px.zw) / params.focal_center_px.xy * z, z);
}

// How far apart normals are compared (pixels). z above 0.
int reach_px(FrameSurfaceParams params, float z) {
    return int(clamp(round(params.reach_px_m / z), params.min_reach_px, params.max_reach_px));
}

// The step along a diagonal that is about as long as `reach` along an axis.
int diagonal_px(int reach) { return int(round(0.7 * float(reach))); }

float depth_sigma_m(FrameSurfaceParams params, float z) { return params.noise_floor_m + params.noise_per_m * z * z; }

// The largest difference in depth between readings of one surface.
float jump_limit_m(FrameSurfaceParams params, float z, int apart_px) {
    return params.jump_m + float(apart_px) * params.jump_slope * z;
}

#endif
