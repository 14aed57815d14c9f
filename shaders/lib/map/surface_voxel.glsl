// Where the voxel that holds a surface point is. The includer declares `view` and
//   CELL(i)         uint, the block id in a cell of the view grid
#ifndef PATINA_LIB_SURFACE_VOXEL_GLSL
#define PATINA_LIB_SURFACE_VOXEL_GLSL
#include "lib/camera/view_grid.glsl"
#include "shared/segmentation/segments.h"

// The voxel's block * kBlockVoxels + its number within it; kNoVoxel where there is no block.
uint surface_voxel(vec3 point_m) {
    const ivec3 voxel = ivec3(floor(point_m / view.grid.voxel_m));
    const uint cell = view_grid_cell(view.grid_low.xyz, view.grid_size.xyz, voxel >> 3);
    const uint block = CELL(cell == kOutsideGrid ? 0u : cell);
    const ivec3 within = voxel & 7;
    return cell == kOutsideGrid || block == kNoBlock
               ? kNoVoxel
               : block * kBlockVoxels + uint(within.z << 6 | within.y << 3 | within.x);
}

#endif
