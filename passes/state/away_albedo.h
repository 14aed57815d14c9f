#pragma once

#include "engine/graph/enlargement.h"
#include "engine/graph/frame_graph.h"
#include "engine/graph/state_visitor.h"
#include "engine/vulkan/device.h"
#include "shared/reflectance/reflectance.h"
#include "shared/segmentation/segments.h"

namespace patina {

/// Sums over the records that are away from the device (observation/stream_records.h): gpu::SegmentAlbedo,
/// gpu::kSweepParts per label, so that the sweep over all labels reaches them part by part. Whole numbers: what comes
/// back is taken out exactly. Lives as long as the observation map.
class AwayAlbedo {
  public:
    /// Throws Error when memory runs out.
    AwayAlbedo(vulkan::Device& device, uint32_t labels);

    /// Nothing is away; the first thing done with it.
    void reset(graph::FrameGraph& frame) const;
    /// Announces that there will be `labels` of them.
    void enlarge(graph::Enlargement& enlargement, uint32_t labels);

    graph::BufferId import(graph::FrameGraph& frame) const { return frame.import(sums_); }

    void visit(graph::StateVisitor& visitor) { visitor.buffer(sums_); }

    uint64_t bytes() const { return sums_->bytes(); }

  private:
    vulkan::BufferRef sums_;
};

}  // namespace patina
