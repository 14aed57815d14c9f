#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/color/srgb.glsl"
#include "shared/scenes/encode_color.h"

layout(local_size_x = 32, local_size_y = 4) in;
layout(rgba32f, binding = 0) uniform readonly image2D linear_color;
layout(std430, binding = 1) writeonly buffer Codes { uint codes[]; };
layout(push_constant) uniform Push { EncodeColorParams params; };

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.extent))) return;
    const uvec3 code = srgb_code(imageLoad(linear_color, ivec2(pixel)).rgb);
    codes[pixel.y * params.extent.x + pixel.x] = code.r | code.g << 8u | code.b << 16u;
}
