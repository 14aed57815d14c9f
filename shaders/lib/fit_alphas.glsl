// The grid of alphas of the Ward fit, and the lobe that ks multiplies. Functions without bindings.
#ifndef PATINA_LIB_FIT_ALPHAS_GLSL
#define PATINA_LIB_FIT_ALPHAS_GLSL
#include "lib/ward.glsl"
#include "shared/ward_fit.h"

const float kFitLog2E = 1.442695;
// Of an exponent to the base of 2: its square is no denormal number, which processors take much longer for.
const float kFitLeastExponent = -60.0;

// Alpha at a place of the grid, which may lie between two.
float fit_alpha(float place) { return kFitMostAlpha * exp2(-place / float(kFitAlphaSteps)); }

// What a lobe without its constant is multiplied by: 1 / (4 pi alpha^2), paper, Eq. 4.
float lobe_scale(float alpha) { return 1.0 / (4.0 * kWardPi * alpha * alpha); }

#endif
