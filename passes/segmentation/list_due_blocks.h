#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/segmentation/due_blocks.h"
#include "passes/state/label_map.h"

namespace patina {

/// Lists those of the visible blocks that were never listed since they were assigned, or have their turn: one in
/// gpu::kUpdateFrames frames, of those where voxels near the surface had no label or were contradicted in
/// gpu::kRestlessFrames, of those that have settled in gpu::kSettledFrames, by their keys. `stamp` is the frame's index
/// + 1.
DueBlocks add_list_due_blocks(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& ids,
                              LabelMapIds& labels, graph::BufferId visible, uint32_t stamp);

}  // namespace patina
