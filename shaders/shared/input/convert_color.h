#ifndef PATINA_SHARED_CONVERT_COLOR_H
#define PATINA_SHARED_CONVERT_COLOR_H
#include "shared/input/lens.h"
INTEROP_BEGIN

// What the alpha channel of a colour image says; the least of what went into a pixel wins. Valid: alpha > 0.
INTEROP_CONST float kColorInvalid = 0.0f;  // not seen, or not finite; rgb is 0
INTEROP_CONST float kColorClipped = 0.5f;  // a channel is clipped: rgb bounds the radiance from below only
INTEROP_CONST float kColorValid = 1.0f;

struct ConvertColorParams {
    Lens lens;
};

INTEROP_END
#endif
