// Light from where there is no surface: sky, what a window shows. By direction alone, as if it came from infinitely
// far.
#ifndef PATINA_SHARED_FAR_FIELD_H
#define PATINA_SHARED_FAR_FIELD_H
#include "shared/input/camera.h"
INTEROP_BEGIN

INTEROP_CONST uint kFarFieldEdge = 32u;        // texels of the octahedral map along each side: 6 degrees each
INTEROP_CONST uint kFarFieldTexels = 1024u;    // of the whole map
INTEROP_CONST float kFarFieldSteps = 1024.0f;  // of a linear pixel value, in whole numbers
INTEROP_CONST uint kFarFieldGroup = 8u;

// Of all pixels that looked into a direction: whole numbers, so that the order of arrival does not matter.
struct FarFieldTexel {
    uvec4 sums;  // rgb: radiance, in steps; w: pixels
};

struct FarFieldParams {
    Camera depth_camera;
    Camera color_camera;
    uvec2 visited;  // how many pixels in x and y are looked at: every stride_px-th
    uint stride_px;
    uint phase;  // which of the stride^2 pixels, changes from frame to frame
};

INTEROP_END
#endif
