// Chromaticity, r and g over r + g + b, in 32 bits: 12 bits each | 8 bits of light, the sum's square root; 0 where it
// is not known. Functions without bindings.
#ifndef PATINA_LIB_CHROMA_GLSL
#define PATINA_LIB_CHROMA_GLSL

const float kLeastLight = 0.02;  // sum of the channels; darker pixels have no chromaticity to speak of
const float kMostLight = 4.0;

uint pack_chroma(vec3 linear) {
    const float light = linear.r + linear.g + linear.b;
    const uvec2 rg = uvec2(clamp(linear.rg / max(light, kLeastLight), 0.0, 1.0) * 4095.0 + 0.5);
    const uint root = uint(sqrt(min(light / kMostLight, 1.0)) * 255.0 + 0.5);
    return light >= kLeastLight ? rg.x | rg.y << 12 | root << 24 : 0u;
}

vec2 unpack_chroma(uint chroma) { return vec2(chroma & 0xfffu, chroma >> 12 & 0xfffu) * (1.0 / 4095.0); }

// The sum of the channels.
float chroma_light(uint chroma) {
    const float root = float(chroma >> 24) * (1.0 / 255.0);
    return root * root * kMostLight;
}

// How far two chromaticities lie apart across the direction from grey, along which highlights move them.
float hue_change(vec2 a, vec2 b) {
    const vec2 one = a - 1.0 / 3.0, two = b - 1.0 / 3.0;
    const float across = abs(one.x * two.y - one.y * two.x) / max(max(length(one), length(two)), 1e-6);
    return dot(one, two) < 0.0 ? distance(a, b) : across;
}

#endif
