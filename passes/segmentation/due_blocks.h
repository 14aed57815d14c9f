#pragma once

#include "engine/graph/frame.h"

namespace patina {

/// Blocks whose voxels a frame's segments label.
struct DueBlocks {
    graph::BufferId
        list;  ///< u32: count, then block ids in no order, | gpu::kSettledBlock if their labels have settled
    graph::BufferId arguments;  ///< dispatch of one group per listed block, in rows of gpu::kGroupsPerRow
};

}  // namespace patina
