// Allocation of voxel blocks along the truncation band of a depth image: touch, select, assign.
#ifndef PATINA_SHARED_ALLOCATE_BLOCKS_H
#define PATINA_SHARED_ALLOCATE_BLOCKS_H
#include "shared/fusion/voxel_map.h"
#include "shared/input/camera.h"
INTEROP_BEGIN

INTEROP_CONST uint kTouchGroupX = 32u;
INTEROP_CONST uint kTouchGroupY = 4u;
INTEROP_CONST uint kSelectGroup = 256u;
INTEROP_CONST uint kAssignGroup = 64u;

// What one frame's fusion knows; a uniform buffer shared by its passes.
struct FusionParams {
    VoxelGrid grid;
    Camera depth_camera;
    Camera color_camera;
    float truncation_m;  // truncation distance t(z) = truncation_m + truncation_slope * z
    float truncation_slope;
    float max_depth_m;   // farther readings are not fused
    float max_weight;    // of a voxel
    float color_band_m;  // voxels this near to the surface take colour
    float max_color_weight;
    uint stride_px;       // every so many pixels in x and y touch blocks
    uint phase;           // which of the stride^2 pixels, changes from frame to frame
    uint max_table_keys;  // beyond it nothing is inserted
    uint frame_index;
    float inverse_sdf_range;   // 1 / (kSdfRangeVox * voxel_m)
    float settled_weight;      // of a voxel whose colour can wait
    uint settled_color_every;  // blocks of such voxels take colour once in so many frames that have one
    uint color_frame;          // how many frames that have one there were before
    uint seed;                 // of the chance by which colours are rounded
    uint pad0;
};

INTEROP_END
#endif
