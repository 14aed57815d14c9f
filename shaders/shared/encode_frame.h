// Turns a traced frame into what a recorded sequence holds: 8-bit sRGB colour, integer depth, 16-bit labels.
#ifndef PATINA_SHARED_ENCODE_FRAME_H
#define PATINA_SHARED_ENCODE_FRAME_H
#include "shared/interop.h"
INTEROP_BEGIN

struct EncodeFrameParams {
    uvec2 extent;           // pixels
    float units_per_metre;  // of depth
    uint pad0;
};

INTEROP_END
#endif
