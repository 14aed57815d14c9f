// Turns rendered radiance into what a colour camera's sensor holds, with its errors.
#ifndef PATINA_SHARED_EXPOSE_COLOR_H
#define PATINA_SHARED_EXPOSE_COLOR_H
#include "shared/scenes/sensor_noise.h"
INTEROP_BEGIN

struct ExposeColorParams {
    uvec2 extent;    // pixels
    float exposure;  // linear value per radiance
    float read;      // variance = read^2 + shot * value
    float shot;
    uint frame;  // of the random numbers, as the seed
    uvec2 seed;
};

INTEROP_END
#endif
