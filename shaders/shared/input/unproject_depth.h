#ifndef PATINA_SHARED_UNPROJECT_DEPTH_H
#define PATINA_SHARED_UNPROJECT_DEPTH_H
#include "shared/input/camera.h"
INTEROP_BEGIN

struct UnprojectDepthParams {
    Camera camera;
    float jump_floor_m;   // neighbours whose depth differs by more than jump_floor_m + jump_relative * z
    float jump_relative;  // lie on another surface
    uint pad0;
    uint pad1;
};

INTEROP_END
#endif
