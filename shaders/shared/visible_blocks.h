// Blocks that a camera can see, and the depth range of the rays through each tile of its image.
#ifndef PATINA_SHARED_VISIBLE_BLOCKS_H
#define PATINA_SHARED_VISIBLE_BLOCKS_H
#include "shared/camera.h"
#include "shared/voxel_map.h"
INTEROP_BEGIN

INTEROP_CONST uint kVisibleGroup = 64u;
INTEROP_CONST uint kTileEdge = 8u;  // pixels

// Where to look, and how far; a uniform buffer shared by the passes that look from one camera.
struct ViewParams {
    VoxelGrid grid;
    Camera camera;
    float near_m;  // along the optical axis
    float far_m;
    uvec2 tiles;  // of kTileEdge pixels, the last ones cut off
};

// Depth range of a tile as the bits of positive floats, which order like the floats: both start as all ones and shrink.
struct TileRange {
    uint near_bits;
    uint far_bits_inverted;
};

INTEROP_END
#endif
