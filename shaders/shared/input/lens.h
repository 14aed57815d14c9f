// A camera with lens distortion (OpenCV's k1 k2 p1 p2 k3), for the passes that remove it; all later passes use
// shared/input/camera.h.
#ifndef PATINA_SHARED_LENS_H
#define PATINA_SHARED_LENS_H
#include "shared/interop.h"
INTEROP_BEGIN

struct Lens {
    vec4 focal_center_px;  // fx, fy, cx, cy; pixel (0, 0) is the centre of the top left pixel
    vec4 radial;           // k1, k2, k3; w: squared radius at z = 1 up to which the distortion does not fold back
    vec2 tangential;       // p1, p2
    uvec2 extent;          // pixels
};

INTEROP_END
#endif
