// What restore_detail looks up of a pixel, in a uvec4 of halves. Functions without bindings.
//   x  kd red, green
//   y  kd blue | 1 where lit, 2 where kd is known, 3 where both
//   z  apparent red, green
//   w  apparent blue, shadow
#ifndef PATINA_LIB_PACKED_DETAIL_GLSL
#define PATINA_LIB_PACKED_DETAIL_GLSL

struct Detail {
    vec3 kd;
    vec3 apparent;  // fused colour over light: the albedo of what is evenly lit and has no highlight
    float shadow;   // the part of the light that shadows leave; below 0: not known
    bool lit;       // and its colour is known
    bool known;     // kd is
};

uvec4 pack_detail(Detail detail) {
    const float flags = (detail.lit ? 1.0 : 0.0) + (detail.known ? 2.0 : 0.0);
    return uvec4(packHalf2x16(detail.kd.rg), packHalf2x16(vec2(detail.kd.b, flags)), packHalf2x16(detail.apparent.rg),
                 packHalf2x16(vec2(detail.apparent.b, detail.shadow)));
}

Detail unpack_detail(uvec4 packed) {
    const vec2 blue = unpackHalf2x16(packed.y), rest = unpackHalf2x16(packed.w);
    return Detail(vec3(unpackHalf2x16(packed.x), blue.x), vec3(unpackHalf2x16(packed.z), rest.x), rest.y,
                  blue.y == 1.0 || blue.y == 3.0, blue.y >= 2.0);
}

#endif
