#pragma once

#include "engine/graph/frame_graph.h"
#include "shared/fusion/voxel_map.h"

namespace patina {

/// The parts of a hash table of blocks; ids are replaced by what is written.
struct BlockTable {
    graph::BufferId& keys;
    graph::BufferId& blocks;
    graph::BufferId block_keys;
    graph::BufferId& counters;
    graph::BufferId block_arguments;  ///< dispatch over all block ids in use
};

/// Enters every block in use in a table whose keys are all empty, and whose count of them is 0. Keys that had been
/// refused are left out and may come again.
void add_rebuild_table(graph::FrameGraph& frame, const BlockTable& table, const gpu::VoxelGrid& grid);

/// The same for a table in use, from which blocks were removed: empties it before.
void add_refill_table(graph::FrameGraph& frame, const BlockTable& table, const gpu::VoxelGrid& grid);

}  // namespace patina
