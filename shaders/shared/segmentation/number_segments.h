// From components, known by sparse keys, to segments numbered 1, 2, ... in the order of the keys.
#ifndef PATINA_SHARED_NUMBER_SEGMENTS_H
#define PATINA_SHARED_NUMBER_SEGMENTS_H
#include "shared/segmentation/frame_segments.h"
INTEROP_BEGIN

INTEROP_CONST uint kNumberGroup = 128u;
INTEROP_CONST uint kNumberQuads = 8u;  // of four keys, one invocation after another
INTEROP_CONST uint kKeysPerGroup = kNumberGroup * kNumberQuads * 4u;
INTEROP_CONST uint kForwardedKey = 0x80000000u;  // | another key, in place of a number of pixels: that key is meant
INTEROP_CONST uint kMeasureGroup = 64u;          // of 32 pixels of a row

// How many components there are.
struct KeyTotals {
    uint kept;       // with enough pixels
    uint too_small;  // with fewer
};

struct NumberSegmentsParams {
    uint min_pixels;  // 1 or more
    uint capacity;    // at most kMaxFrameSegments
    uint groups;
    uint pad0;
};

struct CountGivenParams {
    uvec2 extent;  // pixels
    uint row_words;
    uint keys;  // ids from this on are unknown
};

struct MeasureSegmentsParams {
    uvec2 extent;  // pixels
    uint row_words;
    uint keys;
    uint min_pixels;  // of those that are looked at
    uint area;        // how many each of them stands for
    uint pad0;
    uint pad1;
};

INTEROP_END
#endif
