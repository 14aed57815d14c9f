// Edges between colours.
#ifndef PATINA_SHARED_CUT_COLORS_H
#define PATINA_SHARED_CUT_COLORS_H
#include "shared/interop.h"
INTEROP_BEGIN

struct CutColorsParams {
    mat4 color_from_depth;       // rigid, metres, between the cameras' coordinates
    vec4 depth_focal_center_px;  // fx, fy, cx, cy
    vec4 color_focal_center_px;
    uvec2 extent;         // of the depth camera
    float chroma;         // chromaticities that differ by more are an edge
    int reach_px;         // so near to a geometric edge
    float same_chroma;    // and no edge where they differ by less
    float strong_chroma;  // and lie farther than this from grey
    uint pad0;
    uint pad1;
};

INTEROP_END
#endif
