#pragma once

#include "engine/graph/frame.h"
#include "passes/fusion/visible_blocks.h"
#include "passes/model/label_map.h"

namespace patina {

/// Blocks that a frame's surface points lie in.
struct SurfaceBlocks {
    graph::BufferId list;       ///< u32: count, then block ids in no order
    graph::BufferId arguments;  ///< dispatch of one group per listed block, in rows of gpu::kGroupsPerRow
};

/// Lists the blocks that hold points of `position_m` (W x H rgba32f, world; w is 0 where nothing was hit) and were
/// never listed since they were assigned, or have their turn: one in gpu::kUpdateFrames frames, by their keys. `stamp`
/// is the frame's index + 1.
SurfaceBlocks add_list_surface(graph::Frame& frame, const VoxelMap& map, LabelMapIds& labels,
                               const VisibleBlocks& visible, graph::ImageId position_m, uint32_t stamp);

}  // namespace patina
