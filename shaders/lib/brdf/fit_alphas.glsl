// The grid of alphas of the Ward fit. Functions without bindings.
#ifndef PATINA_LIB_FIT_ALPHAS_GLSL
#define PATINA_LIB_FIT_ALPHAS_GLSL
#include "shared/specular/ward_fit.h"

// Alpha at a place of the grid, which may lie between two.
float fit_alpha(float place) { return kFitMostAlpha * exp2(-place / float(kFitAlphaSteps)); }

#endif
