#pragma once

#include <cstdint>
#include <span>

#include "engine/graph/frame_graph.h"
#include "shared/specular/segment_batch.h"

namespace patina {

/// The segments that one frame estimates, chosen on the device: all passes over it follow their number.
struct SegmentBatch {
    graph::BufferId list;   ///< u32: count, then as many labels, all different; what is beyond the capacity is left out
    uint32_t capacity = 0;  ///< segments that the frame has room for
};

/// Arguments of dispatches over a batch, uvec4 for each entry of `work`: as many groups of gpu::kBatchGroup items as
/// the work takes, none for an empty batch. Throws Error when the batch's capacity is 0 or too large for one of them.
graph::BufferId add_plan_batch(graph::FrameGraph& frame, const SegmentBatch& batch,
                               std::span<const gpu::BatchWork> work);

}  // namespace patina
