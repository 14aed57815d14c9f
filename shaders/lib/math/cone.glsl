#ifndef PATINA_LIB_CONE_GLSL
#define PATINA_LIB_CONE_GLSL
#include "lib/math/pi.glsl"

// The sine of a cone's half angle, whose solid angle is 2 pi (1 - cos): written without the difference of near-equals.
float sine_of_cone(float angle_sr) {
    const float rest = clamp(angle_sr / (2.0 * kPi), 0.0, 1.0);
    return sqrt(rest * (2.0 - rest));
}

#endif
