// How the surface behind a depth reading is inclined, 32 bits per pixel.
#ifndef PATINA_SHARED_SLOPE_H
#define PATINA_SHARED_SLOPE_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST uint kSlopeGroupX = 32u;
INTEROP_CONST uint kSlopeGroupY = 4u;
INTEROP_CONST float kMaxSlope = 0.064f;  // metres of depth per pixel that 11 bits cover; 72 degrees at 4 m and 365 px

struct SlopeParams {
    vec4 focal_center_px;  // fx, fy, cx, cy
    uvec2 extent;
    float jump_m;      // a neighbour whose depth differs by more than jump_m + jump_slope * depth
    float jump_slope;  // belongs to another surface
};

INTEROP_END
#endif
