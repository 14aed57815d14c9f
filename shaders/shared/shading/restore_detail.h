// Detail of the diffuse albedo that is finer than the voxels of the observations.
#ifndef PATINA_SHARED_RESTORE_DETAIL_H
#define PATINA_SHARED_RESTORE_DETAIL_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST uint kRestoreDetailGroup = 8u;  // invocations per side

struct RestoreDetailParams {
    float focal_px;  // of the camera that sees the images
    float voxel_m;   // of the observations
};

INTEROP_END
#endif
