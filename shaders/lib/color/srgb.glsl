// The transfer function of sRGB, IEC 61966-2-1, in 8 bits. Functions without bindings.
#ifndef PATINA_LIB_SRGB_GLSL
#define PATINA_LIB_SRGB_GLSL

// What is above 1 is clipped to 255.
uvec3 srgb_code(vec3 linear) {
    const vec3 v = clamp(linear, 0.0, 1.0);
    const vec3 code = mix(1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, 12.92 * v, lessThanEqual(v, vec3(0.0031308)));
    return uvec3(255.0 * code + 0.5);
}

vec3 linear_of_srgb(uvec3 codes) {
    const vec3 encoded = vec3(codes) / 255.0;
    return mix(pow((encoded + 0.055) / 1.055, vec3(2.4)), encoded / 12.92, lessThanEqual(codes, uvec3(10u)));
}

#endif
