#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/reflectance_state.h"
#include "passes/state/voxel_map.h"

namespace patina {

/// Comes before rays are marched through the map in a frame. Marks in state.surroundings the blocks of the voxel map
/// (gpu::Occupancy), so that rays which are marched after that cross cubes of up to 8 blocks without any in one step.
/// Marks stay when a block goes: rays then take longer, and find the same.
void add_mark_blocks(graph::FrameGraph& frame, ReflectanceStateIds& state, const VoxelMap& map,
                     const VoxelMapIds& voxels);

}  // namespace patina
