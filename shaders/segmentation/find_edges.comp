// Marks pixels at concave creases.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/frame_surface.glsl"

layout(local_size_x = 32, local_size_y = 4) in;
layout(binding = 0, rgba32f) uniform readonly image2D surface;      // normal in camera coordinates; w: depth
layout(binding = 1, r32f) uniform writeonly image2D inner_depth_m;  // negative at edges
layout(push_constant) uniform Push { FrameSurfaceParams params; };

struct Side {
    vec3 normal;
    vec3 point_m;
};

// The surface beside a pixel, or at the pixel itself where the neighbour does not belong to its surface.
Side side_at(ivec2 pixel, vec4 here, ivec2 offset, float limit_m) {
    const ivec2 place = clamp(pixel + offset, ivec2(0), ivec2(params.extent) - 1);
    const vec4 there = imageLoad(surface, place);
    const bool joined = dot(there.xyz, there.xyz) > 0.0 && abs(there.w - here.w) <= limit_m;
    return Side(joined ? there.xyz : here.xyz,
                surface_point_m(params, joined ? place : pixel, joined ? there.w : here.w));
}

bool is_crease(ivec2 pixel, vec4 here, ivec2 offset, float limit_m, float cosine) {
    const Side a = side_at(pixel, here, -offset, limit_m);
    const Side b = side_at(pixel, here, offset, limit_m);
    const bool concave = dot(b.point_m - a.point_m, b.normal - a.normal) < 0.0;
    return concave && dot(a.normal, b.normal) < cosine;
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(params.extent)))) return;
    const vec4 here = imageLoad(surface, pixel);
    const float z = max(here.w, 1e-3);
    const int reach = reach_px(params, z);
    const int diagonal = diagonal_px(reach);
    const float limit_m = jump_limit_m(params, z, reach);
    // The error of a normal that was fitted to eight readings, and of the angle between two.
    const float spread_px = sqrt(float(2 * reach * reach + 4 * diagonal * diagonal));
    const float sigma_rad = 1.4142 * depth_sigma_m(params, z) * params.focal_center_px.x / (z * spread_px);
    const float cosine = cos(min(params.crease_rad + params.crease_sigmas * sigma_rad, 3.1415));

    const bool edge = dot(here.xyz, here.xyz) == 0.0 || is_crease(pixel, here, ivec2(reach, 0), limit_m, cosine) ||
                      is_crease(pixel, here, ivec2(0, reach), limit_m, cosine);
    imageStore(inner_depth_m, pixel, vec4(edge ? -here.w : here.w));
}
