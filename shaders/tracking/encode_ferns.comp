// A frame's code: four ferns' codes a word.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/tracking/keyframes.h"

layout(local_size_x = kFernGroup) in;
layout(binding = 0, rgba32f) uniform readonly image2D picture;
layout(std430, binding = 1) readonly buffer Ferns { Fern ferns[]; };
layout(std430, binding = 2) writeonly buffer Code { uint words[]; };

uint code_of(Fern fern) {
    const vec4 value = imageLoad(picture, ivec2(fern.pixel));
    uint code = 0u;
    if (value.r >= 0.0) {
        const uvec3 above = uvec3(greaterThan(value.rgb, fern.color.rgb));
        code = kFernHasColor | above.r * kFernRed | above.g * kFernGreen | above.b * kFernBlue;
    }
    if (value.a > 0.0) code |= kFernHasDepth | (value.a > fern.depth_m ? kFernDepth : 0u);
    return code;
}

void main() {
    const uint word = gl_GlobalInvocationID.x;
    if (word >= kFernWords) return;
    uint codes = 0u;
    for (uint i = 0u; i < 4u; ++i) codes |= code_of(ferns[4u * word + i]) << (8u * i);
    words[word] = codes;
}
