// Perceptual parameters of Ward's materials (Pellacini et al. 2000), in which equal steps look about equally large:
// CIELAB of kd over 100, c = cbrt(ks + kd / 2) - cbrt(kd / 2) per channel, d = 1 - alpha. Functions without bindings.
#ifndef PATINA_LIB_PERCEPTUAL_GLSL
#define PATINA_LIB_PERCEPTUAL_GLSL
#include "shared/specular/specular_estimates.h"

const float kLeastRoughness = 0.01;
const vec3 kD65White = vec3(0.95047, 1.0, 1.08883);
const mat3 kXyzOfSrgb = mat3(0.4124564, 0.2126729, 0.0193339,  // linear; columns: what red, green and blue give
                             0.3575761, 0.7151522, 0.1191920, 0.1804375, 0.0721750, 0.9503041);
const mat3 kSrgbOfXyz =
    mat3(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314, 0.0415560, 1.0572252);
const float kLabLinear = 6.0 / 29.0;  // cube roots below go on as straight lines

vec3 cube_root(vec3 v) { return sign(v) * pow(abs(v), vec3(1.0 / 3.0)); }

// CIELAB over 100.
vec3 lab_of(vec3 rgb) {
    const vec3 t = kXyzOfSrgb * rgb / kD65White;
    const float limit = kLabLinear * kLabLinear * kLabLinear;
    const vec3 f = mix(t / (3.0 * kLabLinear * kLabLinear) + 4.0 / 29.0, cube_root(t), greaterThan(t, vec3(limit)));
    return vec3(1.16 * f.y - 0.16, 5.0 * (f.x - f.y), 2.0 * (f.y - f.z));
}
vec3 rgb_of_lab(vec3 lab) {
    const float y = (lab.x + 0.16) / 1.16;
    const vec3 f = vec3(y + lab.y / 5.0, y, y - lab.z / 2.0);
    const vec3 t = mix(3.0 * kLabLinear * kLabLinear * (f - 4.0 / 29.0), f * f * f, greaterThan(f, vec3(kLabLinear)));
    return kSrgbOfXyz * (t * kD65White);
}

PerceptualMaterial perceptual_of(WardMaterial material) {
    const vec3 half_kd = material.kd_weight.rgb * 0.5;
    const vec3 c = cube_root(material.ks_alpha.rgb + half_kd) - cube_root(half_kd);
    return PerceptualMaterial(vec4(lab_of(material.kd_weight.rgb), c.r),
                              vec4(c.gb, 1.0 - material.ks_alpha.w, material.kd_weight.w));
}

// Its inverse; kd within [0, 1], ks not negative, and alpha at least kLeastRoughness.
WardMaterial material_of(PerceptualMaterial w) {
    const vec3 kd = rgb_of_lab(w.lab_cr.xyz), root = vec3(w.lab_cr.w, w.cgb_d_weight.xy) + cube_root(kd * 0.5);
    const vec3 ks = root * root * root - kd * 0.5;
    return WardMaterial(vec4(clamp(kd, 0.0, 1.0), w.cgb_d_weight.w),
                        vec4(max(ks, 0.0), max(1.0 - w.cgb_d_weight.z, kLeastRoughness)));
}

#endif
