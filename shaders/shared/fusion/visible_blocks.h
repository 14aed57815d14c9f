// Blocks that a camera can see, and the depth range of the rays through each tile of its image.
#ifndef PATINA_SHARED_VISIBLE_BLOCKS_H
#define PATINA_SHARED_VISIBLE_BLOCKS_H
#include "shared/fusion/voxel_map.h"
#include "shared/input/camera.h"
INTEROP_BEGIN

INTEROP_CONST uint kVisibleGroup = 64u;
INTEROP_CONST uint kTileEdge = 8u;          // pixels
INTEROP_CONST float kGridMarginVox = 2.0f;  // how far outside the frustum the view grid holds blocks

// Where to look, and how far; a uniform buffer shared by the passes that look from one camera.
struct ViewParams {
    VoxelGrid grid;
    Camera camera;
    float near_m;  // along the optical axis
    float far_m;
    uvec2 tiles;      // of kTileEdge pixels, the last ones cut off
    ivec4 grid_low;   // xyz: the lowest block coordinates of the box around the frustum; w unused
    uvec4 grid_size;  // xyz: the box's size in blocks; w unused
};

// Depth range of a tile as the bits of positive floats, which order like the floats: both start as all ones and shrink.
struct TileRange {
    uint near_bits;
    uint far_bits_inverted;
};

INTEROP_END
#endif
