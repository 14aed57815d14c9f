// Which texel of the far field holds a direction. Functions without bindings.
#ifndef PATINA_LIB_FAR_FIELD_GLSL
#define PATINA_LIB_FAR_FIELD_GLSL
#include "lib/math/octahedral.glsl"
#include "shared/reflectance/far_field.h"

uint far_field_texel(vec3 direction) { return octahedral_texel(direction, kFarFieldEdge); }

// Radiance from a direction; a is 0 where no pixel looked.
vec4 far_radiance(FarFieldTexel texel) {
    const float pixels = float(texel.sums.w);
    return pixels > 0.0 ? vec4(vec3(texel.sums.rgb) / (pixels * kFarFieldSteps), 1.0) : vec4(0.0);
}

#endif
