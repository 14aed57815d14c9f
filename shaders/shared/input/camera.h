// A pinhole camera as shaders see it; lens distortion has been removed before.
#ifndef PATINA_SHARED_CAMERA_H
#define PATINA_SHARED_CAMERA_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST float kNearestDepth = 1e-3f;  // metres; what is nearer, or behind the camera, is not seen

struct Camera {
    mat4 camera_from_world;  // rigid, metres; camera axes x right, y down, z forward
    vec4 focal_center_px;    // fx, fy, cx, cy; pixel (0, 0) is the centre of the top left pixel
    uvec2 extent;            // pixels
    uint pad0;
    uint pad1;
};

INTEROP_END
#endif
