#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/fusion/visible_blocks.h"
#include "passes/state/voxel_map.h"

namespace patina {

/// Gives back those of the visible blocks in which no voxel has been seen within 95 % of the narrowest truncation
/// (gpu::FusionParams in `params`) from the surface: noise and free space. Then rebuilds the table from the blocks that
/// remain, without tombstones and without the keys that had been refused a block, which get another chance. Voxels of
/// the remaining blocks stay as they are; those of the others are cleared when their block is assigned again. Counts in
/// MapCounters::deleted_blocks.
void add_remove_empty_blocks(graph::FrameGraph& frame, const VoxelMap& map, VoxelMapIds& ids,
                             const VisibleBlocks& visible, graph::BufferId params);

}  // namespace patina
