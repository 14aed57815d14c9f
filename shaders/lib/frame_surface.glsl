// A frame's surface in camera coordinates (shared/find_edges.h). Functions without bindings.
#ifndef PATINA_LIB_FRAME_SURFACE_GLSL
#define PATINA_LIB_FRAME_SURFACE_GLSL
#include "shared/find_edges.h"

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
