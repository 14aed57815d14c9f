// Marks pixels at concave creases and at steps.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shared/find_edges.h"

layout(local_size_x = 32, local_size_y = 4) in;
layout(binding = 0, rgba32f) uniform readonly image2D surface;      // normal in camera coordinates; w: depth
layout(binding = 1, r32f) uniform writeonly image2D inner_depth_m;  // negative at edges
layout(push_constant) uniform Push { FindEdgesParams params; };

vec3 position_m(ivec2 pixel, float z) {
    return vec3((vec2(pixel) - params.focal_center_px.zw) / params.focal_center_px.xy * z, z);
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 last = ivec2(params.extent) - 1;
    if (any(greaterThan(pixel, last))) return;
    const vec4 here = imageLoad(surface, pixel);
    const vec3 point = position_m(pixel, here.w);
    const float z = max(here.w, 1e-3);
    const int reach = int(clamp(round(params.reach_px_m / z), params.min_reach_px, params.max_reach_px));
    const float step_m = params.step_floor_m + params.step_sigmas * (params.noise_floor_m + params.noise_per_m * z * z);

    bool edge = dot(here.xyz, here.xyz) == 0.0;
    [[unroll]] for (int y = -1; y <= 1; ++y) {
        [[unroll]] for (int x = -1; x <= 1; ++x) {
            if (x == 0 && y == 0) continue;
            const ivec2 neighbour = clamp(pixel + reach * ivec2(x, y), ivec2(0), last);
            const vec4 there = imageLoad(surface, neighbour);
            const vec3 offset = position_m(neighbour, there.w) - point;
            // How far each point lies above the other's tangent plane. Two planes that meet between the points lie both
            // below (convex) or both above (concave) each other's points; else there is a step between them.
            const float there_above = dot(offset, here.xyz);
            const float here_above = -dot(offset, there.xyz);
            const bool step = there_above * here_above < 0.0 && min(abs(there_above), abs(here_above)) > step_m;
            const bool crease = there_above + here_above > 0.0 && dot(here.xyz, there.xyz) < params.crease_cosine;
            // Where the neighbour has no normal, it is an edge itself and says nothing about this pixel.
            edge = edge || (dot(there.xyz, there.xyz) > 0.0 && (step || crease));
        }
    }
    imageStore(inner_depth_m, pixel, vec4(edge ? -here.w : here.w));
}
