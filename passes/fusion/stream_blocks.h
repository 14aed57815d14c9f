#pragma once

#include <cstdint>
#include <optional>

#include "engine/graph/frame_graph.h"
#include "passes/state/label_map.h"
#include "passes/state/voxel_map.h"
#include "shared/fusion/stream_blocks.h"

namespace patina {

/// What leaves the device in one frame. Blocks stand in the same order in all of them, which may differ from run to
/// run; which blocks these are does not.
struct LeavingBlocks {
    graph::BufferId counts;  ///< u32[gpu::kLeavingWords]
    graph::BufferId count;   ///< u32, blocks in the lists
    graph::BufferId blocks;  ///< gpu::StreamedBlock per block
    graph::BufferId tsdf;    ///< gpu::kBlockVoxels u32 per block
    graph::BufferId color;   ///< likewise
    graph::BufferId labels;  ///< likewise; invalid without labels
};

/// Takes blocks outside a region off the device, at most `most` and about as many where there are more: copies their
/// voxels for the host to read, gives their places back, and empties the table of their keys. MapCounters::left_blocks
/// counts them. `labels` is null where the map has none.
LeavingBlocks add_leave_blocks(graph::FrameGraph& frame, const VoxelMap& map, VoxelMapIds& ids, LabelMapIds* labels,
                               const gpu::StreamRegion& region, uint32_t most);

/// Blocks that come back, in any order.
struct ReturningBlocks {
    uint32_t count = 0;
    graph::BufferId blocks;  ///< gpu::StreamedBlock per block; `block` is undefined
    graph::BufferId tsdf;    ///< gpu::kBlockVoxels u32 per block
    graph::BufferId color;   ///< likewise
    graph::BufferId labels;  ///< likewise; invalid without labels
};

/// Brings blocks back before a frame touches blocks. Returns their list: gpu::StreamedBlock::block is kNoBlock where
/// the pool was full (MapCounters::refused_blocks counts that); such a block is still away. A key that has a block
/// already gets the voxels that come back.
graph::BufferId add_return_blocks(graph::FrameGraph& frame, const VoxelMap& map, VoxelMapIds& ids, LabelMapIds* labels,
                                  const ReturningBlocks& returning);

}  // namespace patina
