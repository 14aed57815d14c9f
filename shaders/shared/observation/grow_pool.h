// Pools that grow between frames: passes/fusion/grow_voxels.h, passes/observation/grow_observations.h.
#ifndef PATINA_SHARED_GROW_POOL_H
#define PATINA_SHARED_GROW_POOL_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST uint kGrowGroup = 64u;

struct GrowParams {
    uint before;  // places of the pool so far
    uint added;   // and how many come
};

struct RetryParams {
    uint block_voxels;  // entries of the record table that a block of observations has
};

INTEROP_END
#endif
