// An albedo with a state in one word: ten bits a channel, of its square root, as what is dark shows smaller steps.
// Functions without bindings.
#ifndef PATINA_LIB_PACKED_ALBEDO_GLSL
#define PATINA_LIB_PACKED_ALBEDO_GLSL

// `albedo` from 0 to 1, `state` from 0 to 3.
uint pack_albedo(vec3 albedo, uint state) {
    const uvec3 steps = uvec3(sqrt(clamp(albedo, 0.0, 1.0)) * 1023.0 + 0.5);
    return steps.r | steps.g << 10u | steps.b << 20u | state << 30u;
}

vec3 unpack_albedo(uint word) {
    const vec3 root = vec3(uvec3(word, word >> 10u, word >> 20u) & 1023u) / 1023.0;
    return root * root;
}

uint state_of(uint word) { return word >> 30u; }

#endif
