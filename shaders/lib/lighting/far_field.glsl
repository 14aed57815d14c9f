// Which texel of the far field holds a direction. Functions without bindings.
#ifndef PATINA_LIB_FAR_FIELD_GLSL
#define PATINA_LIB_FAR_FIELD_GLSL
#include "lib/math/octahedral.glsl"
#include "shared/reflectance/far_field.h"

uint far_field_texel(vec3 direction) {
    const vec2 at = (to_octahedral(direction) * 0.5 + 0.5) * float(kFarFieldEdge);
    const uvec2 texel = min(uvec2(max(at, 0.0)), uvec2(kFarFieldEdge - 1u));
    return texel.y * kFarFieldEdge + texel.x;
}

// Radiance from a direction; a is 0 where no pixel looked.
vec4 far_radiance(FarFieldTexel texel) {
    const float pixels = float(texel.sums.w);
    return pixels > 0.0 ? vec4(vec3(texel.sums.rgb) / (pixels * kFarFieldSteps), 1.0) : vec4(0.0);
}

#endif
