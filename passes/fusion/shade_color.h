#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/fusion/visible_blocks.h"
#include "passes/state/voxel_map.h"

namespace patina {

/// The map's fused colour at surface points: `position_m` is W x H rgba32f as add_raycast makes it from
/// `visible`. Returns W x H
/// rgba16f, linear, the trilinear mean over those neighbouring voxels that have a colour; a = 1, or all zero where
/// nothing was hit or no neighbour has a colour.
graph::ImageId add_shade_color(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& ids,
                               const VisibleBlocks& visible, graph::ImageId position_m);

}  // namespace patina
