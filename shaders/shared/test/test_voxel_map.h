// For tests of the voxel map: inserting arbitrary keys, reading blocks wherever they lie.
#ifndef PATINA_SHARED_TEST_VOXEL_MAP_H
#define PATINA_SHARED_TEST_VOXEL_MAP_H
#include "shared/fusion/voxel_map.h"
INTEROP_BEGIN

struct TestMapParams {
    VoxelGrid grid;
    uint count;  // keys to insert, blocks to gather
    uint pad0;
    uint pad1;
    uint pad2;
};

INTEROP_END
#endif
