// How much an observation counts for the Ward fit, in one word: a float whose last three bits say which channels do.
#ifndef PATINA_LIB_FIT_WEIGHTS_GLSL
#define PATINA_LIB_FIT_WEIGHTS_GLSL

uint pack_fit_weight(float weight, bvec3 channels) {
    const uint flags = uint(channels.r) | uint(channels.g) << 1 | uint(channels.b) << 2;
    return weight > 0.0 && flags != 0u ? floatBitsToUint(weight) & ~7u | flags : 0u;
}
float fit_weight(uint word) { return uintBitsToFloat(word & ~7u); }
vec3 fit_channel_weights(uint word) { return fit_weight(word) * vec3(uvec3(word) >> uvec3(0u, 1u, 2u) & 1u); }

#endif
