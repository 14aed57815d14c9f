// What the random numbers of a sensor's errors are used for (lib/math/random.glsl): the stream is that of the pixel x |
// y << 16 in the sequence's frame, the index 0, the dimension one of these, which no sampler of light uses.
#ifndef PATINA_SHARED_SENSOR_NOISE_H
#define PATINA_SHARED_SENSOR_NOISE_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST uint kDepthNoise = 0x6e000000u;  // does it fly, how far, and two numbers for the Gaussian
INTEROP_CONST uint kColorNoise = 0x6e000001u;  // two pairs, for the Gaussians of red and green, and of blue

INTEROP_END
#endif
