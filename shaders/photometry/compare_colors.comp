#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Weighs, per channel, by how many stops the frame's colours differ from the model's at the same surface points. Whole
// numbers add up to the same in any order.
#include "shared/photometry/color_gains.h"

layout(local_size_x = kCompareColorsGroupX, local_size_y = kCompareColorsGroupY) in;
layout(binding = 0, rgba32f) uniform readonly image2D position_m;
layout(binding = 1, rgba16f) uniform readonly image2D normal;
layout(binding = 2, rgba16f) uniform readonly image2D model_color;
layout(binding = 3, rgba16f) uniform readonly image2D color_linear;
layout(std430, binding = 4) buffer Histogram { uint weights[]; };
layout(push_constant) uniform Push { CompareColorsParams params; };

// Darker values are coarse in 8 bits (a step of sRGB is 5 % at 0.015); brighter ones of the model may come from frames
// in which they were clipped.
const float kDarkest = 0.015;
const float kBrightest = 0.7;
const float kMostContrast = 1.25;  // among the pixels of one sample: at edges the picture and the model mix otherwise
// The logarithm of a value is the surer, the brighter that is; and dark ones show least of the exposure, most of flare
// and of what cameras mix between channels.
const float kWeightOfWhite = 64.0;
const float kJump_m = 0.01;  // off the tangent plane, plus the next per metre of depth: another surface
const float kJumpPerMetre = 0.01;

// The surface goes on in all four directions: what is near an edge may be another surface's colour.
bool is_even(ivec2 pixel, vec4 point, vec3 n) {
    bool even = true;
    [[unroll]] for (int i = 0; i < 4; ++i) {
        const ivec2 side = i < 2 ? ivec2(2 * i - 1, 0) : ivec2(0, 2 * i - 5);
        const vec4 there = imageLoad(position_m, pixel + side);
        even = even && there.w > 0.0 && abs(dot(n, there.xyz - point.xyz)) <= kJump_m + kJumpPerMetre * point.w;
    }
    return even;
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(position_m)))) return;
    const vec4 point = imageLoad(position_m, pixel);
    const vec4 known = imageLoad(model_color, pixel);
    const vec3 n = imageLoad(normal, pixel).xyz;
    const vec3 toward = params.camera_m.xyz - point.xyz;
    if (point.w <= 0.0 || known.a <= 0.0 || dot(n, toward) < params.least_cosine * length(toward)) return;
    if (!is_even(pixel, point, n)) return;

    const vec2 center = (vec2(pixel) + 0.5) * params.color_per_px - 0.5;
    const vec2 t = fract(center);
    vec4 seen = vec4(0.0);
    vec3 least = vec3(kBrightest), most = vec3(0.0);
    bool valid = true;
    [[unroll]] for (int i = 0; i < 4; ++i) {
        const ivec2 corner = ivec2(i & 1, i >> 1);
        const vec4 tap = imageLoad(color_linear, ivec2(floor(center)) + corner);
        const vec2 share = mix(1.0 - t, t, vec2(corner));
        valid = valid && tap.a == 1.0;
        seen += tap * (share.x * share.y);
        least = min(least, tap.rgb);
        most = max(most, tap.rgb);
    }
    [[unroll]] for (uint c = 0u; c < 3u; ++c) {
        const bool in_range = min(least[c], known[c]) >= kDarkest && max(most[c], known[c]) <= kBrightest;
        if (!valid || !in_range || most[c] > kMostContrast * least[c]) continue;
        const float bin = floor((log2(seen[c] / known[c]) + kGainRangeStops) * kGainBinsPerStop + 0.5);
        if (bin < 0.0 || bin >= float(kGainBins)) continue;
        atomicAdd(weights[c * kGainBins + uint(bin)], uint(kWeightOfWhite * sqrt(seen[c] * known[c])) + 1u);
        atomicAdd(weights[3u * kGainBins + c], 1u);
    }
}
