// What restore_detail looks up of a pixel. Functions without bindings.
//   x  kd, with a shared exponent; 0 where it is not known
//   y  picture_kd, with a shared exponent
//   z  apparent red, green, halves
//   w  apparent blue, below 0 where not lit; shadow; halves
#ifndef PATINA_LIB_PACKED_DETAIL_GLSL
#define PATINA_LIB_PACKED_DETAIL_GLSL
#include "lib/records/observations.glsl"

struct Detail {
    vec3 kd;
    vec3 picture_kd;
    vec3 apparent;  // fused colour over light: the albedo of what is evenly lit and has no highlight
    float shadow;   // the part of the light that shadows leave; below 0: not known
    bool lit;       // and its colour is known
    bool known;     // kd is
};

uvec4 pack_detail(Detail detail) {
    return uvec4(detail.known ? max(pack_shared_exponent(detail.kd), 1u) : 0u, pack_shared_exponent(detail.picture_kd),
                 packHalf2x16(detail.apparent.rg),
                 packHalf2x16(vec2(detail.lit ? detail.apparent.b : -1.0, detail.shadow)));
}

Detail unpack_detail(uvec4 packed) {
    const vec2 rest = unpackHalf2x16(packed.w);
    return Detail(unpack_shared_exponent(packed.x), unpack_shared_exponent(packed.y),
                  vec3(unpackHalf2x16(packed.z), max(rest.x, 0.0)), rest.y, rest.x >= 0.0, packed.x != 0u);
}

#endif
