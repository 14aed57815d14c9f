// Smooths the small picture: Gaussian means over what is valid.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/tracking/keyframes.h"

layout(local_size_x = kShrinkFrameGroup, local_size_y = kShrinkFrameGroup) in;
layout(binding = 0, rgba32f) uniform readonly image2D boxes;
layout(binding = 1, rgba32f) uniform writeonly image2D smoothed;
layout(push_constant) uniform Push { SmoothFrameParams params; };

const float kLeastValidShare = 0.5;  // of the weight inside the picture

void main() {
    const ivec2 extent = ivec2(kSmallWidth, kSmallHeight);
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, extent))) return;
    const ivec2 begin = max(pixel - params.radius_px, ivec2(0));
    const ivec2 end = min(pixel + params.radius_px, extent - 1);
    vec4 sums = vec4(0.0);     // colour, depth
    vec2 weights = vec2(0.0);  // of colour, of depth
    float whole = 0.0;
    for (int y = begin.y; y <= end.y; ++y) {
        for (int x = begin.x; x <= end.x; ++x) {
            const vec2 offset = vec2(ivec2(x, y) - pixel);
            const float weight = exp2(params.exponent_per_px2 * dot(offset, offset));
            const vec4 value = imageLoad(boxes, ivec2(x, y));
            const vec2 valid = vec2(value.r >= 0.0 ? weight : 0.0, value.a > 0.0 ? weight : 0.0);
            sums += value * valid.xxxy;
            weights += valid;
            whole += weight;
        }
    }
    const vec3 rgb = weights.x >= kLeastValidShare * whole ? sums.rgb / weights.x : vec3(-1.0);
    const float depth_m = weights.y >= kLeastValidShare * whole ? sums.a / weights.y : 0.0;
    imageStore(smoothed, pixel, vec4(rgb, depth_m));
}
