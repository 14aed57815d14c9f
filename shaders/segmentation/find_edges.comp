// Marks pixels at concave creases, at steps, and between colours.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/color/chroma.glsl"
#include "lib/segments/frame_surface.glsl"

layout(local_size_x = 128) in;  // of one row: software devices take a group of several rows longer
layout(binding = 0, r32f) uniform readonly image2D depth_m;
layout(binding = 1, r32ui) uniform readonly uimage2D normal;
layout(binding = 2, r32ui) uniform readonly uimage2D chroma;
layout(binding = 3, r32f) uniform writeonly image2D inner_depth_m;  // negative at edges
layout(push_constant) uniform Push { FrameSurfaceParams params; };

struct Side {
    vec3 normal;
    vec3 point_m;
};

// The surface beside a pixel, or at the pixel itself where the neighbour does not belong to its surface.
Side side_at(ivec2 pixel, Side here, ivec2 offset, float limit_m) {
    const ivec2 place = clamp(pixel + offset, ivec2(0), ivec2(params.extent) - 1);
    const float z = imageLoad(depth_m, place).x;
    const uint packed = imageLoad(normal, place).x;
    const bool joined = packed != 0u && abs(z - here.point_m.z) <= limit_m;
    return Side(joined ? unpack_normal(packed) : here.normal,
                joined ? surface_point_m(params, place, z) : here.point_m);
}

const float kParallelCosine = 0.95;  // of the normals on both sides of a step, which it tilts

// What the surface does from one side of a pixel to the other.
struct Bend {
    bool crease;  // a concave crease, or a step
    bool fold;    // a convex one, which does not separate
};

Bend bend_at(ivec2 pixel, Side here, ivec2 offset, float limit_m, float cosine, float step_m) {
    const Side a = side_at(pixel, here, -offset, limit_m);
    const Side b = side_at(pixel, here, offset, limit_m);
    const vec3 across_m = b.point_m - a.point_m;
    const bool concave = dot(across_m, b.normal - a.normal) < 0.0;
    const float between = dot(a.normal, b.normal);
    // A curved surface does not leave the plane that stands on the mean normal.
    const bool is_step = abs(dot(across_m, a.normal + b.normal)) > 2.0 * step_m && between > kParallelCosine;
    return Bend((concave && between < cosine) || is_step, !concave && between < kParallelCosine);
}

// Over a fold the light changes, and with it how much of a colour is highlight: only another hue counts there.
bool differ(ivec2 pixel, ivec2 offset, bool fold) {
    // Outside the image loads are zero: not known.
    const uint a = imageLoad(chroma, pixel - offset).x, b = imageLoad(chroma, pixel + offset).x;
    const vec2 one = unpack_chroma(a), two = unpack_chroma(b), apart = abs(one - two);
    const float light = chroma_light(min(a, b));
    const float change = fold ? hue_change(one, two) : max(apart.x, apart.y);
    return light > 0.0 && change > params.cut_chroma + params.cut_light / max(light, 1e-3);
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(params.extent)))) return;
    const float depth = imageLoad(depth_m, pixel).x;
    const uint packed = imageLoad(normal, pixel).x;
    const float z = max(depth, 1e-3);
    const Side here = Side(unpack_normal(packed), surface_point_m(params, pixel, z));
    const int reach = reach_px(params, z);
    const float limit_m = jump_limit_m(params, z, reach);
    // The error of a normal that was fitted to eight depths, and of the angle between two.
    const int diagonal = diagonal_px(reach);
    const float spread_px = sqrt(float(2 * reach * reach + 4 * diagonal * diagonal));
    const float sigma_rad = 1.4142 * depth_sigma_m(params, z) * params.focal_center_px.x / (z * spread_px);
    const float cosine = cos(min(params.crease_rad + params.crease_sigmas * sigma_rad, 3.1415));

    const float step_m = params.step_m + params.step_sigmas * depth_sigma_m(params, z);

    const Bend x = bend_at(pixel, here, ivec2(reach, 0), limit_m, cosine, step_m);
    const Bend y = bend_at(pixel, here, ivec2(0, reach), limit_m, cosine, step_m);
    const bool edge = packed == 0u || x.crease || y.crease || differ(pixel, ivec2(params.color_reach_px, 0), x.fold) ||
                      differ(pixel, ivec2(0, params.color_reach_px), y.fold);
    imageStore(inner_depth_m, pixel, vec4(edge ? -depth : depth));
}
