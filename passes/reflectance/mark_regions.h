#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/reflectance_state.h"
#include "passes/state/voxel_map.h"

namespace patina {

/// Comes before rays are marched through the map in a frame. Marks in state.surroundings the regions of the voxel map
/// that have a block, of gpu::kMapRegionBlocks blocks along each side, so that rays which are marched after that cross
/// the others in one step. Marks stay when a block goes: rays then take longer, and find the same.
void add_mark_regions(graph::FrameGraph& frame, ReflectanceStateIds& state, const VoxelMap& map,
                      const VoxelMapIds& voxels);

}  // namespace patina
