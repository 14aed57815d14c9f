#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/encode_frame.h"

layout(local_size_x = 32, local_size_y = 4) in;
layout(rgba32f, binding = 0) uniform readonly image2D radiance;
layout(r32f, binding = 1) uniform readonly image2D depth_m;
layout(r32ui, binding = 2) uniform readonly uimage2D object_id;
layout(std430, binding = 3) writeonly buffer Encoded { uvec2 encoded[]; };
layout(push_constant) uniform Push { EncodeFrameParams params; };

// IEC 61966-2-1: linear to an 8-bit code; what is above 1 is clipped to 255.
uvec3 srgb_code(vec3 linear) {
    const vec3 v = clamp(linear, 0.0, 1.0);
    const vec3 code = mix(1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, 12.92 * v, lessThanEqual(v, vec3(0.0031308)));
    return uvec3(255.0 * code + 0.5);
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.extent))) return;
    const ivec2 at = ivec2(pixel);
    const uvec3 code = srgb_code(imageLoad(radiance, at).rgb);
    const float units = floor(imageLoad(depth_m, at).x * params.units_per_metre + 0.5);
    const uint depth = units <= 65535.0 ? uint(units) : 0u;
    const uint color = code.r | code.g << 8u | code.b << 16u;
    encoded[pixel.y * params.extent.x + pixel.x] = uvec2(color, depth | imageLoad(object_id, at).x << 16u);
}
