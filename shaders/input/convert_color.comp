// Turns a colour picture as the camera gave it into linear radiance as a pinhole camera would see it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/camera/lens.glsl"
#include "lib/color/srgb.glsl"
#include "shared/input/convert_color.h"

layout(local_size_x = 32, local_size_y = 4) in;
layout(constant_id = 0) const bool kLinear = false;                    // the source holds linear floats, not sRGB bytes
layout(constant_id = 1) const bool kDistorted = false;                 // the source has lens distortion
layout(std430, binding = 0) readonly buffer Source { uint words[]; };  // three channels a pixel, without padding
layout(binding = 1, rgba16f) uniform writeonly image2D color;
layout(push_constant) uniform Push { ConvertColorParams params; };

const float kMaxHalf = 65504.0;

vec4 linear_at(uint index) {
    const uvec3 bits = uvec3(words[3u * index], words[3u * index + 1u], words[3u * index + 2u]);
    // Comparing bits finds infinity and NaN even where a driver's float arithmetic does not keep them.
    if (any(greaterThanEqual(bits & 0x7fffffffu, uvec3(0x7f800000u)))) return vec4(0.0, 0.0, 0.0, kColorInvalid);
    const vec3 rgb = uintBitsToFloat(bits);
    const bool clipped = any(greaterThan(rgb, vec3(kMaxHalf)));
    return vec4(clamp(rgb, 0.0, kMaxHalf), clipped ? kColorClipped : kColorValid);
}

vec4 srgb_at(uint index) {
    const uint bit = index * 24u;
    const uint word = bit >> 5u;
    const uint shift = bit & 31u;
    uint packed_rgb = words[word] >> shift;
    // Only a pixel that crosses into the next word reads it: the last pixel may end the buffer.
    if (shift > 8u) packed_rgb |= words[word + 1u] << (32u - shift);
    const uvec3 codes = (uvec3(packed_rgb) >> uvec3(0u, 8u, 16u)) & 255u;
    return vec4(linear_of_srgb(codes), any(equal(codes, uvec3(255u))) ? kColorClipped : kColorValid);
}

vec4 color_at(uvec2 pixel) {
    const uint index = pixel.y * params.lens.extent.x + pixel.x;
    if (kLinear) return linear_at(index);
    return srgb_at(index);
}

// Bilinear in linear light; the outer half of the border pixels repeats their centre.
vec4 interpolated(vec2 source_px) {
    const vec2 inner = clamp(source_px, vec2(0.0), vec2(params.lens.extent - 1u));
    const uvec2 a = uvec2(inner);
    const uvec2 b = min(a + 1u, params.lens.extent - 1u);
    const vec4 c00 = color_at(a), c10 = color_at(uvec2(b.x, a.y));
    const vec4 c01 = color_at(uvec2(a.x, b.y)), c11 = color_at(b);
    const vec2 t = inner - vec2(a);
    const vec3 rgb = mix(mix(c00.rgb, c10.rgb, t.x), mix(c01.rgb, c11.rgb, t.x), t.y);
    return vec4(rgb, min(min(c00.a, c10.a), min(c01.a, c11.a)));
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.lens.extent))) return;
    vec4 result = vec4(0.0, 0.0, 0.0, kColorInvalid);
    if (kDistorted) {
        vec2 source_px;
        if (find_source(params.lens, pixel, source_px)) result = interpolated(source_px);
    } else {
        result = color_at(pixel);
    }
    imageStore(color, ivec2(pixel), result.a == kColorInvalid ? vec4(0.0, 0.0, 0.0, kColorInvalid) : result);
}
