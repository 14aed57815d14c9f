// What a depth camera sees, and its colours as another camera saw them.
#ifndef PATINA_SHARED_CHOOSE_DEPTH_H
#define PATINA_SHARED_CHOOSE_DEPTH_H
#include "shared/interop.h"
INTEROP_BEGIN

struct ChooseDepthParams {
    mat4 color_from_depth;       // rigid, metres, between the cameras' coordinates
    vec4 depth_focal_center_px;  // fx, fy, cx, cy
    vec4 color_focal_center_px;
    uvec2 extent;  // of the depth camera
    uint pad0;
    uint pad1;
};

INTEROP_END
#endif
