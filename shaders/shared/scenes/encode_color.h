// Turns linear colour into 8-bit sRGB codes.
#ifndef PATINA_SHARED_ENCODE_COLOR_H
#define PATINA_SHARED_ENCODE_COLOR_H
#include "shared/interop.h"
INTEROP_BEGIN

struct EncodeColorParams {
    uvec2 extent;  // pixels
};

INTEROP_END
#endif
