#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/voxel_map.h"
#include "shared/fusion/visible_blocks.h"

namespace patina {

/// The blocks that one camera can see.
struct VisibleBlocks {
    graph::BufferId view;       ///< gpu::ViewParams
    graph::BufferId list;       ///< u32: count, then block ids in no particular order
    graph::BufferId arguments;  ///< dispatch of one group per listed block, in rows of gpu::kGroupsPerRow
    graph::BufferId
        grid;  ///< u32 per block of the box around the frustum, x fastest: block id, kNoBlock where none is visible
    graph::BufferId tiles;  ///< gpu::TileRange per tile of kTileEdge x kTileEdge pixels, row by row
    Extent2D extent;        ///< of the camera's image
};

/// How far a camera sees at most, metres along its optical axis: far_m, or less where the grid of blocks around the
/// frustum would take more than 128 MiB (of a Kinect v2, with voxels of 5 mm, beyond 7 m).
float view_reach_m(const gpu::Camera& camera, float voxel_m, float far_m);

/// How far from a camera's centre the farthest point of its frustum lies that ends at `far_m` along its axis.
double frustum_radius_m(const gpu::Camera& camera, float far_m);

/// Lists the blocks whose bounding box meets the camera's frustum between near_m and far_m, or view_reach_m() where
/// that is nearer, and finds the depth range in which the rays of each image tile can meet blocks (ray interval
/// splatting, Niessner et al. 2013).
VisibleBlocks add_visible_blocks(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& ids,
                                 const gpu::Camera& camera, float near_m, float far_m);

}  // namespace patina
