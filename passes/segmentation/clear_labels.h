#pragma once

#include "engine/graph/frame.h"
#include "passes/model/voxel_map.h"

namespace patina {

/// Clears the labels of the blocks that this frame's allocation assigned (fusion/allocate_blocks.h), as that clears
/// their distances and colours. Returns `labels` (LabelMap) after that.
graph::BufferId add_clear_labels(graph::Frame& frame, const VoxelMap& map, const VoxelMapIds& ids,
                                 graph::BufferId labels);

}  // namespace patina
