// Gives pixels without a segment, such as edges, to the segment nearby whose tangent plane they lie on.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "lib/frame_surface.glsl"

layout(local_size_x = 32, local_size_y = 4) in;
layout(binding = 0, r32f) uniform readonly image2D depth_m;
layout(binding = 1, r32ui) uniform readonly uimage2D normal;
layout(binding = 2, r32ui) uniform readonly uimage2D component;
layout(std430, binding = 3) readonly buffer Pixels { uint pixels[]; };  // by component; of 0: 0
layout(binding = 4, r32ui) uniform writeonly uimage2D claimed;
layout(push_constant) uniform Push { FrameSurfaceParams params; };

const ivec2 kDirections[4] = ivec2[](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));

ivec2 clamped(ivec2 pixel) { return clamp(pixel, ivec2(0), ivec2(params.extent) - 1); }

// The pixel's component, 0 where it is too small.
uint component_at(ivec2 pixel) {
    const uint key = imageLoad(component, pixel).x;
    return pixels[key] >= params.min_pixels ? key : 0u;
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(params.extent)))) return;
    uint own = component_at(pixel);
    const float z = imageLoad(depth_m, pixel).x;
    const bool wanting = own == 0u && z > 0.0;

    // The nearest component in each direction. No branch: software devices leave the loop as soon as no pixel of a
    // vector needs it.
    uvec4 found = uvec4(0u);
    ivec4 apart = ivec4(0);
    for (int step = 1; wanting && any(equal(found, uvec4(0u))) && step <= params.claim_reach_px; ++step) {
        [[unroll]] for (int i = 0; i < 4; ++i) {
            const uint there = component_at(clamped(pixel + step * kDirections[i]));
            apart[i] = found[i] == 0u ? step : apart[i];
            found[i] = found[i] == 0u ? there : found[i];
        }
    }
    const vec3 point_m = surface_point_m(params, pixel, z);
    float nearest_m = params.claim_m + params.claim_sigmas * depth_sigma_m(params, z);
    [[unroll]] for (int i = 0; i < 4; ++i) {
        const ivec2 place = clamped(pixel + apart[i] * kDirections[i]);
        const vec3 there_m = surface_point_m(params, place, imageLoad(depth_m, place).x);
        const float distance_m = abs(dot(there_m - point_m, unpack_normal(imageLoad(normal, place).x)));
        const bool nearer = found[i] != 0u && distance_m < nearest_m;
        own = nearer ? found[i] : own;
        nearest_m = nearer ? distance_m : nearest_m;
    }
    imageStore(claimed, pixel, uvec4(own));
}
