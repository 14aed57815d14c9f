// What is around, coarsely: the mean colour of each cell that a picture showed a surface in. Openings such as windows
// count as surfaces in the plane of their rims. See passes/reflectance/collect_surroundings.h.
#ifndef PATINA_SHARED_SURROUNDINGS_H
#define PATINA_SHARED_SURROUNDINGS_H
#include "shared/input/camera.h"
INTEROP_BEGIN

INTEROP_CONST float kSurroundingsCellM = 0.05f;     // edge of a cell
INTEROP_CONST uint kSurroundingsCells = 0x40000u;   // of the table, a power of two: 650 m^2 of surface
INTEROP_CONST uint kSurroundingsProbes = 16u;       // places looked at, from the key's own on
INTEROP_CONST float kSurroundingsSteps = 256.0f;    // of a linear pixel value, in whole numbers
INTEROP_CONST float kSurroundingsRange = 64.0f;     // the largest of them
INTEROP_CONST uint kLeastSurroundingsSamples = 3u;  // pixels that make a cell a surface
INTEROP_CONST uint kSurroundingsGroup = 8u;

// Of pixels. Whole numbers, so that the order of arrival does not matter.
struct SurroundingsSums {
    uint samples;
    uint r;  // of their colours, in steps
    uint g;
    uint b;
};

struct SurroundingsCell {
    uint key;                // lib/lighting/surroundings.glsl; 0: nothing is here
    SurroundingsSums usual;  // as the recording shows it, clipped where it is bright
    SurroundingsSums low;    // at low exposure, in the recording's pixel values
};

struct SurroundingsParams {
    Camera depth_camera;
    Camera color_camera;
    uvec2 visited;  // how many pixels in x and y are looked at: every stride_px-th
    uint stride_px;
    uint phase;            // which of the stride^2 pixels, changes from frame to frame
    float radiance_scale;  // of a frame of low exposure: the recording's exposure over its own; 0: a usual frame
    float lamp_luminance;  // of a frame of low exposure: from which a pixel is a lamp's, which is left out
    uint pad0;
    uint pad1;
};

INTEROP_END
#endif
