// Means of depth and of colour over boxes of the frame, a small picture's pixel each.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/input/convert_color.h"
#include "shared/tracking/keyframes.h"

layout(local_size_x = kShrinkFrameGroup, local_size_y = kShrinkFrameGroup) in;
layout(binding = 0, r32f) uniform readonly image2D depth_m;
layout(binding = 1, rgba16f) uniform readonly image2D color;
layout(binding = 2, rgba32f) uniform writeonly image2D boxes;
layout(push_constant) uniform Push { ShrinkFrameParams params; };

// With fewer valid pixels in its box, a mean tells of some other place.
const float kLeastValidShare = 0.25;

// The first pixel of a box, and the one after its last; a box has one pixel at least.
uvec4 box_of(uvec2 small, uvec2 extent) {
    const uvec2 size = uvec2(kSmallWidth, kSmallHeight);
    const uvec2 begin = small * extent / size;
    return uvec4(begin, max((small + 1u) * extent / size, begin + 1u));
}

float pixels_of(uvec4 box) { return float((box.z - box.x) * (box.w - box.y)); }

float mean_depth(uvec4 box) {
    vec2 sum = vec2(0.0);
    for (uint y = box.y; y < box.w; ++y) {
        for (uint x = box.x; x < box.z; ++x) {
            const float depth = imageLoad(depth_m, ivec2(x, y)).x;
            if (depth > 0.0) sum += vec2(depth, 1.0);
        }
    }
    return sum.y > 0.0 && sum.y >= kLeastValidShare * pixels_of(box) ? sum.x / sum.y : 0.0;
}

// Square roots spread thresholds over tones about as eyes see them.
vec3 mean_color(uvec4 box) {
    vec4 sum = vec4(0.0);
    for (uint y = box.y; y < box.w; ++y) {
        for (uint x = box.x; x < box.z; ++x) {
            const vec4 pixel = imageLoad(color, ivec2(x, y));
            if (pixel.a != kColorInvalid) sum += vec4(pixel.rgb, 1.0);
        }
    }
    return sum.a > 0.0 && sum.a >= kLeastValidShare * pixels_of(box) ? sqrt(sum.rgb / sum.a) : vec3(-1.0);
}

void main() {
    const uvec2 small = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(small, uvec2(kSmallWidth, kSmallHeight)))) return;
    const vec3 rgb = mean_color(box_of(small, params.color_extent));
    imageStore(boxes, ivec2(small), vec4(rgb, mean_depth(box_of(small, params.depth_extent))));
}
