#ifndef PATINA_SHARED_FILTER_DEPTH_H
#define PATINA_SHARED_FILTER_DEPTH_H
#include "shared/interop.h"
INTEROP_BEGIN

// Pixels to each side; 5 x 5 pixels hold what matters at a spatial sigma of 2 pixels.
INTEROP_CONST int kFilterDepthRadius = 2;

struct FilterDepthParams {
    uvec2 extent;            // pixels
    float spatial_exponent;  // a neighbour d pixels away weighs exp2(spatial_exponent * d * d)
    float sigma_floor_m;     // sigma(z) = max(sigma_floor_m, z * (sigma_linear + z * sigma_quadratic))
    float sigma_linear;      // 1
    float sigma_quadratic;   // 1 / m
    uint pad0;
    uint pad1;
};

INTEROP_END
#endif
