#version 460
#extension GL_GOOGLE_include_directive : require
// Divides a frame's colours by its gains.
#include "shared/input/convert_color.h"
#include "shared/photometry/color_gains.h"

layout(local_size_x = 32, local_size_y = 4) in;
layout(std430, binding = 0) readonly buffer Gains { ColorGains gains; };
layout(binding = 1, rgba16f) uniform readonly image2D color_linear;
layout(binding = 2, rgba16f) uniform writeonly image2D corrected;

const float kMaxHalf = 65504.0;

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(color_linear)))) return;
    const vec4 seen = imageLoad(color_linear, pixel);
    vec3 rgb = min(seen.rgb / gains.gain.rgb, kMaxHalf);
    // By values of 1 and above, readers tell which channels of a clipped pixel are clipped.
    if (seen.a == kColorClipped) rgb = mix(rgb, max(rgb, 1.0), greaterThanEqual(seen.rgb, vec3(1.0)));
    imageStore(corrected, pixel, vec4(rgb, seen.a));
}
