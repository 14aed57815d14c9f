#pragma once

#include "engine/graph/frame_graph.h"

namespace patina {

/// Blocks whose voxels a frame's segments label.
struct DueBlocks {
    graph::BufferId
        list;  ///< u32: count, then block ids in no order, | gpu::kSettledBlock if their labels have settled
    graph::BufferId arguments;  ///< dispatch of a group per gpu::kUpdateBlocks of them, in rows of gpu::kGroupsPerRow
};

}  // namespace patina
