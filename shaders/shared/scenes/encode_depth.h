// Turns rendered depth into a depth camera's integer readings, with its errors.
#ifndef PATINA_SHARED_ENCODE_DEPTH_H
#define PATINA_SHARED_ENCODE_DEPTH_H
#include "shared/scenes/sensor_noise.h"
INTEROP_BEGIN

struct EncodeDepthParams {
    uvec2 extent;           // pixels
    float units_per_metre;  // of the readings
    float constant_m;       // sigma = constant + quadratic (z - offset)^2
    float quadratic_per_m;
    float offset_m;
    float flying_pixels;  // share of the pixels at an edge
    uint frame;           // of the random numbers, as the seed
    uvec2 seed;
};

INTEROP_END
#endif
