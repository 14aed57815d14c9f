// Records whose surface went: passes/observation/reclaim_records.h.
#ifndef PATINA_SHARED_RECLAIM_H
#define PATINA_SHARED_RECLAIM_H
#include "shared/fusion/stream_blocks.h"
INTEROP_BEGIN

INTEROP_CONST uint kReclaimGroup = 64u;  // invocations of a group, which looks at as many block ids
INTEROP_CONST uint kReclaimParts = 4u;   // of the observations, by their blocks' keys; one is looked at at a time

struct ReclaimParams {
    VoxelGrid voxels;     // the voxel map's; both maps have the same keys
    uint edge_shift;      // a block has 1 << edge_shift observation voxels along each edge
    uint part;            // that has its turn
    float surface_limit;  // a stored distance below it is near the surface
    uint pad0;
    StreamRegion region;  // where the voxel map is known
};

INTEROP_END
#endif
