#pragma once
#include "passes/fusion/visible_blocks.h"
namespace patina {
inline void add_remove_empty_blocks(graph::Frame&, const VoxelMap&, VoxelMapIds&, const VisibleBlocks&,
                                    graph::BufferId) {}
}  // namespace patina
