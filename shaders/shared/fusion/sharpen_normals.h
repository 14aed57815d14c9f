// Normals of the cast model, each taken from its own side of an edge.
#ifndef PATINA_SHARED_SHARPEN_NORMALS_H
#define PATINA_SHARED_SHARPEN_NORMALS_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST uint kSharpenGroup = 8u;  // invocations per side

struct SharpenNormalsParams {
    float focal_px;  // of the camera that sees the model
    float voxel_m;   // of the volume
};

INTEROP_END
#endif
