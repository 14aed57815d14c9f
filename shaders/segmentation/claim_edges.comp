// Gives pixels without a segment, such as edges, to the segment nearby whose tangent plane they lie on.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shared/draw_segments.h"

layout(local_size_x = 32, local_size_y = 4) in;
layout(binding = 0, rgba32f) uniform readonly image2D surface;  // normal in camera coordinates; w: depth
layout(binding = 1, r32ui) uniform readonly uimage2D segment;
layout(binding = 2, r32ui) uniform writeonly uimage2D claimed;
layout(push_constant) uniform Push { ClaimEdgesParams params; };

vec3 position_m(ivec2 pixel, float z) {
    return vec3((vec2(pixel) - params.focal_center_px.zw) / params.focal_center_px.xy * z, z);
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 last = ivec2(params.extent) - 1;
    if (any(greaterThan(pixel, last))) return;
    uint own = imageLoad(segment, pixel).x;
    const float z = imageLoad(surface, pixel).w;
    const vec3 point = position_m(pixel, z);
    float nearest_m = params.step_floor_m + params.step_sigmas * (params.noise_floor_m + params.noise_per_m * z * z);
    const bool wanting = own == 0u && z > 0.0;

    const ivec2 directions[4] = ivec2[](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));
    [[unroll]] for (int i = 0; i < 4; ++i) {
        uint found = 0u;
        ivec2 place = pixel;
        // A loop and no branch: software devices leave it as soon as no pixel of a vector needs it.
        for (int step = 1; wanting && found == 0u && step <= params.reach_px; ++step) {
            place = clamp(pixel + step * directions[i], ivec2(0), last);
            found = imageLoad(segment, place).x;
        }
        const vec4 there = imageLoad(surface, place);
        const float distance_m = abs(dot(position_m(place, there.w) - point, there.xyz));
        const bool nearer = found != 0u && distance_m < nearest_m;
        own = nearer ? found : own;
        nearest_m = nearer ? distance_m : nearest_m;
    }
    imageStore(claimed, pixel, uvec4(own));
}
