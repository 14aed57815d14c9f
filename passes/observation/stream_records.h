#pragma once

#include <cstdint>

#include "engine/graph/frame_graph.h"
#include "passes/state/observation_map.h"
#include "passes/state/reflectance_state.h"
#include "shared/observation/stream_records.h"

namespace patina {

/// What passes that move records read and replace.
struct StreamedMap {
    const ObservationMap& map;
    ObservationMapIds& ids;
    ReflectanceStateIds& state;
    graph::BufferId& away;  ///< AwayAlbedo
};

/// Records that leave the device in one frame. Blocks stand in any order, the records of one side by side; which ones
/// these are does not differ from run to run.
struct LeavingRecords {
    graph::BufferId counts;      ///< u32[gpu::kLeavingWords]; counts are of records
    graph::BufferId count;       ///< gpu::LeavingCount
    graph::BufferId blocks;      ///< gpu::StreamedBlock per block
    graph::BufferId records;     ///< gpu::StreamedRecord per record
    graph::BufferId directions;  ///< gpu::kRecordQuads uvec4 per record
    graph::BufferId colors;      ///< likewise
};

/// Takes the blocks outside a region off the device with their records, at most `most` records and about as many where
/// there are more: copies them for the host to read, counts them as away, gives their places back, and empties the
/// table of their keys. Blocks without a record are given up. MapCounters::left_blocks counts. `voxels`: the voxel
/// map's grid. Whoever keeps record ids from frame to frame has to choose them anew in the same frame.
LeavingRecords add_leave_records(graph::FrameGraph& frame, StreamedMap streamed, const gpu::VoxelGrid& voxels,
                                 const gpu::StreamRegion& region, uint32_t most);

/// Records that come back.
struct ReturningRecords {
    uint32_t block_count = 0, record_count = 0;
    graph::BufferId blocks;      ///< gpu::StreamedBlock per block, with its key and the place of its records
    graph::BufferId records;     ///< gpu::StreamedRecord per record, in the order of blocks
    graph::BufferId directions;  ///< gpu::kRecordQuads uvec4 per record
    graph::BufferId colors;      ///< likewise
};

/// Brings records back before a frame observes. Returns the list of blocks: gpu::StreamedBlock::block is kNoBlock where
/// a pool was full (MapCounters::refused_blocks counts that); such a block is still away. Of a key that has a block
/// already, what comes back is dropped.
graph::BufferId add_return_records(graph::FrameGraph& frame, StreamedMap streamed, const ReturningRecords& returning);

}  // namespace patina
