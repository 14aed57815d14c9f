#pragma once

#include <cstdint>

#include "engine/graph/enlargement.h"
#include "engine/graph/frame_graph.h"
#include "engine/graph/state_visitor.h"
#include "engine/vulkan/device.h"
#include "shared/segmentation/segment_samples.h"

namespace patina {

/// Versions of the samples' buffers within one frame.
struct SegmentSampleIds {
    graph::BufferId counts;  ///< gpu::SegmentSampleCount per label
    graph::BufferId kept;    ///< u32 record ids, gpu::kSegmentSamples per label, in no order
    graph::BufferId kd;      ///< gpu::SegmentKd per label: of the records that were kept, as they were then
};

/// References to records of an observation map by segment: all of them where there are at most gpu::kSegmentSamples,
/// else between half as many and that, chosen by hashes of their voxels and a seed: first of those with enough
/// observations, then of others. So every record of each kind is as likely to be among them as any other, whenever it
/// came, and the same ones are in every run. Filled by segmentation/sample_records.h.
class SegmentSamples {
  public:
    /// Throws Error when memory runs out.
    SegmentSamples(vulkan::Device& device, uint32_t labels);

    /// No segment has any; the first thing done with it.
    void reset(graph::FrameGraph& frame) const;

    /// Announces that there will be `labels` of them; new ones have no records.
    void enlarge(graph::Enlargement& enlargement, uint32_t labels);

    SegmentSampleIds import(graph::FrameGraph& frame) const {
        return {frame.import(counts_), frame.import(kept_), frame.import(kd_)};
    }
    static void keep(graph::FrameGraph& frame, const SegmentSampleIds& ids);

    void visit(graph::StateVisitor& visitor);

    uint32_t labels() const { return labels_; }
    uint64_t bytes() const { return counts_->bytes() + kept_->bytes() + kd_->bytes(); }

  private:
    uint32_t labels_;
    vulkan::BufferRef counts_, kept_, kd_;
};

}  // namespace patina
