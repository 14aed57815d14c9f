// What is around, coarsely: the mean colour of each cell that a picture showed a surface in. Openings such as windows
// count as surfaces in the plane of their rims; what shows in them is kept by direction, too, since it is far away. See
// passes/reflectance/collect_surroundings.h.
#ifndef PATINA_SHARED_SURROUNDINGS_H
#define PATINA_SHARED_SURROUNDINGS_H
#include "shared/input/camera.h"
#include "shared/reflectance/occupancy.h"
INTEROP_BEGIN

INTEROP_CONST float kSurroundingsCellM = 0.05f;    // edge of a cell
INTEROP_CONST uint kSurroundingsCells = 0x80000u;  // of the table, a power of two
// Cells in use, 330 m^2 of surface: in so empty a table each finds its place, whatever the order of arrival.
INTEROP_CONST uint kMostSurroundings = 0x20000u;
INTEROP_CONST uint kMarkBlocksGroup = 64u;
INTEROP_CONST uint kSurroundingsProbes = 32u;       // places looked at, from the key's own on
INTEROP_CONST float kSurroundingsSteps = 256.0f;    // of a linear pixel value, in whole numbers
INTEROP_CONST float kSurroundingsRange = 16.0f;     // the largest of them
INTEROP_CONST uint kLeastSurroundingsSamples = 3u;  // pixels that make a cell a surface
INTEROP_CONST float kNearlyClipped = 0.8f;          // a mean of pixels some of which may be clipped
INTEROP_CONST uint kSurroundingsGroup = 8u;
INTEROP_CONST uint kOpeningEdge = 64u;      // texels of what openings show along each side: 3 degrees each
INTEROP_CONST uint kOpeningTexels = 4096u;  // of the whole octahedral map
INTEROP_CONST uint kOpeningGroup = 64u;
INTEROP_CONST uint kOpeningTurns = 16u;  // frames after which each direction has looked at the known ones around

// Of pixels. Whole numbers, so that the order of arrival does not matter.
struct SurroundingsSums {
    uint samples;
    uint r;  // of their colours, in steps
    uint g;
    uint b;
};

struct SurroundingsLight {
    SurroundingsSums usual;  // as the recording shows it, clipped where it is bright
    SurroundingsSums low;    // at low exposure, in the recording's pixel values
};

struct SurroundingsCell {
    uint key;       // lib/lighting/surroundings.glsl; 0: nothing is here
    uint openings;  // of its samples, those of pixels without depth
    SurroundingsLight light;
};

// What openings show in a direction.
struct OpeningTexel {
    SurroundingsLight light;
    uint known;  // 1: r, g, b are what openings show in this direction, or those around tell; kOpeningTurns frames old
    float r;
    float g;
    float b;
};

// How many cells are in use. A frame sees the count before it, so that all its pixels find the same.
struct SurroundingsCounts {
    uint total;  // before the frame
    uint fresh;  // that the frame adds
    uint pad0;
    uint pad1;
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

struct OpeningParams {
    uint turn;  // which of kOpeningTurns
};

INTEROP_END

// The buffer of the surroundings, after what is seen far away (shared/reflectance/far_field.h) and in openings, with
// which of its cells, and which blocks of the voxel map, are in use.
#ifndef __cplusplus
#define SURROUNDINGS_MEMBERS                  \
    FarFieldTexel far_field[kFarFieldTexels]; \
    OpeningTexel openings[kOpeningTexels];    \
    SurroundingsCounts surroundings_counts;   \
    Occupancy cells_in_use;                   \
    Occupancy blocks_in_use;                  \
    SurroundingsCell surroundings[];
#endif
#endif
