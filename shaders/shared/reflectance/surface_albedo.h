// Albedo of stretches of surface that look alike. See passes/reflectance/surface_albedo.h.
#ifndef PATINA_SHARED_SURFACE_ALBEDO_H
#define PATINA_SHARED_SURFACE_ALBEDO_H
#include "shared/reflectance/reflectance.h"
INTEROP_BEGIN

INTEROP_CONST float kSurfaceCellM = 0.16f;        // edge of a cell
INTEROP_CONST float kSurfaceBrightness = 0.25f;   // height of a cell: log of what the surface reflects, by e
INTEROP_CONST float kSurfaceTint = 0.3f;          // width of a cell: log of the ratio of two channels
INTEROP_CONST float kSurfaceDarkest = 0.01f;      // added to pixel values before the logarithm
INTEROP_CONST uint kSurfaceCells = 0x40000u;      // of the table, a power of two
INTEROP_CONST uint kMostSurfaceCells = 0x10000u;  // in use: in so empty a table each finds its place
INTEROP_CONST uint kSurfaceProbes = 32u;          // places looked at, from the key's own on
INTEROP_CONST float kSurfaceSteps = 4096.0f;      // of pixel values, in whole numbers
INTEROP_CONST float kSurfaceRange = 16.0f;        // the largest of them

// Sums over records. Whole numbers, so that the order of arrival does not matter.
struct SurfaceCell {
    uint key;  // lib/records/surface_cells.glsl; 0: nothing is here
    uint records;
    uint reflected_r;  // what they reflect diffusely
    uint reflected_g;
    uint reflected_b;
    uint light_r;  // what they receive
    uint light_g;
    uint light_b;
};

struct SurfaceAlbedoParams {
    VoxelGrid grid;   // the observation map's
    uint edge_shift;  // of the observation map
    uint pad0;
    uint pad1;
    uint pad2;
    vec4 cube_m;  // centre in the world, half edge: records outside neither tell nor hear anything
};

INTEROP_END
#endif
