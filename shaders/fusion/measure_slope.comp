#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Fits the tangent plane of each reading from its neighbours in the smoothed depth image.
#include "lib/map/slope.glsl"

layout(local_size_x = kSlopeGroupX, local_size_y = kSlopeGroupY) in;
layout(binding = 0, r32f) uniform readonly image2D smooth_depth_m;
layout(binding = 1, r32ui) uniform writeonly uimage2D slope;
layout(push_constant) uniform Push { SlopeParams params; };

float load(ivec2 pixel) {
    const ivec2 inside = clamp(pixel, ivec2(0), ivec2(params.extent) - 1);
    return pixel == inside ? imageLoad(smooth_depth_m, inside).x : 0.0;
}

// Depth per pixel from the neighbours on both sides, or from the one that belongs to the same surface. `known` becomes
// false where none does.
float difference(float before, float here, float after, float jump_m, inout bool known) {
    const bool has_before = before > 0.0 && abs(here - before) <= jump_m;
    const bool has_after = after > 0.0 && abs(after - here) <= jump_m;
    const float sum = (has_before ? here - before : 0.0) + (has_after ? after - here : 0.0);
    known = known && (has_before || has_after);
    return has_before && has_after ? 0.5 * sum : sum;
}

// One of the eight pixels around shows something nearer.
bool is_beside_edge(ivec2 pixel, float here, float jump_m) {
    bool beside = false;
    [[unroll]] for (int i = 0; i < 9; ++i) {
        const float there = load(pixel + ivec2(i % 3 - 1, i / 3 - 1));
        beside = beside || (there > 0.0 && there < here - jump_m);
    }
    return beside;
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(params.extent)))) return;
    const float here = load(pixel);
    const float jump_m = params.jump_m + params.jump_slope * here;
    bool known = here > 0.0;
    const vec2 depth_per_px =
        vec2(difference(load(pixel - ivec2(1, 0)), here, load(pixel + ivec2(1, 0)), jump_m, known),
             difference(load(pixel - ivec2(0, 1)), here, load(pixel + ivec2(0, 1)), jump_m, known));
    // The plane z = here + gx du + gy dv, as a plane in space: its normal is (-gx fx, -gy fy, z + gx (u - cx) + gy (v -
    // cy)), whose product with the ray (x, y, 1) is z.
    const vec2 from_center = vec2(pixel) - params.focal_center_px.zw;
    const vec3 normal = vec3(-depth_per_px * params.focal_center_px.xy, here + dot(depth_per_px, from_center));
    const float plane_factor = here / max(length(normal), 1e-6);
    imageStore(slope, pixel,
               uvec4(known ? pack_slope(depth_per_px, plane_factor, is_beside_edge(pixel, here, jump_m)) : 0u));
}
