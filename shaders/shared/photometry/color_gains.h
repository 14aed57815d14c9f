// What a camera's automatic exposure and white balance multiply a frame's colours by. See passes/photometry.
#ifndef PATINA_SHARED_COLOR_GAINS_H
#define PATINA_SHARED_COLOR_GAINS_H
#include "shared/interop.h"
INTEROP_BEGIN

// The histogram of log2(frame / model): the weights of kGainBins per channel, the first centred at -kGainRangeStops;
// then the count of samples per channel.
INTEROP_CONST uint kGainBins = 512u;
INTEROP_CONST float kGainBinsPerStop = 128.0f;  // a bin is 0.5 % wide
INTEROP_CONST float kGainRangeStops = 2.0f;     // a gain is 1/4 to 4; what lies beyond does not count
INTEROP_CONST uint kGainHistogramWords = 3u * kGainBins + 3u;

INTEROP_CONST uint kCompareColorsGroupX = 32u;
INTEROP_CONST uint kCompareColorsGroupY = 4u;
INTEROP_CONST uint kSettleGainsGroup = 128u;  // one group per channel

// One frame's gains: its linear pixel values over what they were at the exposure of the first frame.
struct ColorGains {
    vec4 gain;      // rgb; w unused
    uvec4 samples;  // that each channel's gain was estimated from; w unused
};

struct CompareColorsParams {
    vec4 camera_m;       // xyz: the colour camera's centre, world
    vec2 color_per_px;   // pixels of the colour picture per pixel of the cast, in x and y
    float least_cosine;  // between the model's normal and the direction to the camera
    uint pad0;
};

struct SettleGainsParams {
    uint min_samples;  // with fewer, a channel keeps the gain of the frame before
    float leak;        // of the logarithm of a gain, that is lost
};

INTEROP_END
#endif
