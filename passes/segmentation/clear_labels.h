#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/label_map.h"
#include "passes/state/voxel_map.h"

namespace patina {

/// Clears the labels of the blocks that this frame's allocation assigned (fusion/allocate_blocks.h), as that clears
/// their distances and colours.
void add_clear_labels(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& ids, LabelMapIds& labels);

}  // namespace patina
