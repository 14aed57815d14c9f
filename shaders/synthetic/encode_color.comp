#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/encode_color.h"

layout(local_size_x = 32, local_size_y = 4) in;
layout(rgba32f, binding = 0) uniform readonly image2D linear_color;
layout(std430, binding = 1) writeonly buffer Codes { uint codes[]; };
layout(push_constant) uniform Push { EncodeColorParams params; };

// IEC 61966-2-1: linear to an 8-bit code; what is above 1 is clipped to 255.
uvec3 srgb_code(vec3 linear) {
    const vec3 v = clamp(linear, 0.0, 1.0);
    const vec3 code = mix(1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, 12.92 * v, lessThanEqual(v, vec3(0.0031308)));
    return uvec3(255.0 * code + 0.5);
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.extent))) return;
    const uvec3 code = srgb_code(imageLoad(linear_color, ivec2(pixel)).rgb);
    codes[pixel.y * params.extent.x + pixel.x] = code.r | code.g << 8u | code.b << 16u;
}
