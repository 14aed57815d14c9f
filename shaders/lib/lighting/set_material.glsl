// How estimates become the materials of segments. Functions without bindings.
#ifndef PATINA_LIB_SET_MATERIAL_GLSL
#define PATINA_LIB_SET_MATERIAL_GLSL
#include "shared/reflectance/reflectance.h"

const float kSeenKsStep = 0.002;    // a change of ks that is worth another look at the albedo, and
const float kSeenShareStep = 0.02;  // of ks and alpha, relative,
const float kObservedStep = 0.05;   // or of how much of ks is a guess
const float kSureMirror = 0.9;      // SegmentMaterial::mirror of what is taken for a metal or a mirror

// Albedos depend on the version, and are computed again when it changes. `unobserved`: the share of ks that is a guess.
SegmentMaterial changed_material(SegmentMaterial known, vec4 ks_alpha, float unobserved) {
    const vec3 step = vec3(kSeenKsStep) + kSeenShareStep * known.ks_alpha.rgb;
    const bool differs = any(greaterThan(abs(ks_alpha.rgb - known.ks_alpha.rgb), step)) ||
                         abs(ks_alpha.w - known.ks_alpha.w) > kSeenShareStep * known.ks_alpha.w ||
                         abs(unobserved - known.unobserved) > kObservedStep;
    if (known.version != 0u && !differs) return known;
    // Records keep 16 bits of it.
    return SegmentMaterial(ks_alpha, known.version % 0xffffu + 1u, known.mirror, unobserved, 0u);
}

#endif
