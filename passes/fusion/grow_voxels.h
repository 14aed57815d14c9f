#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/voxel_map.h"

namespace patina {

/// Makes use of a voxel map's larger pool, in the frame in which its enlargement from `before` blocks was committed:
/// the new blocks become free, and the larger table is filled with the blocks in use. Keys that the full pool refused
/// are forgotten, so that they come again. Blocks keep their ids and voxels.
void add_grow_voxels(graph::FrameGraph& frame, const VoxelMap& map, VoxelMapIds& ids, uint32_t before);

}  // namespace patina
