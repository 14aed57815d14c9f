#ifndef PATINA_SHARED_KINECT2_REGISTER_COLOR_H
#define PATINA_SHARED_KINECT2_REGISTER_COLOR_H
#include "shared/kinect2/infrared.h"
INTEROP_BEGIN

INTEROP_CONST uint kRegisterColorGroup = 128u;  // invocations, for a whole row of depth pixels
INTEROP_CONST uint kColorWidth = 1920u;         // pixels
INTEROP_CONST uint kColorHeight = 1080u;        // pixels
INTEROP_CONST uint kCoverColumns = 2u;          // colour columns that are looked at as one for what hides them

struct RegisterColorParams {
    float shift_px_m;  // what 1 / z adds to the column in the colour picture
    float tolerance;   // a pixel is hidden where another one is nearer by this share of its depth
    uint pad0;
    uint pad1;
};

INTEROP_END
#endif
