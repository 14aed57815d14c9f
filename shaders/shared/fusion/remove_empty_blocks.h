// Deletion of blocks that hold no surface.
#ifndef PATINA_SHARED_REMOVE_EMPTY_BLOCKS_H
#define PATINA_SHARED_REMOVE_EMPTY_BLOCKS_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST uint kRemoveGroup = 128u;  // invocations per block, four voxels each
INTEROP_CONST float kSurfaceTruncation =
    0.95f;  // a voxel is near the surface below this share of the narrowest truncation

INTEROP_END
#endif
