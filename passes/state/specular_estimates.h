#pragma once

#include <cstdint>

#include "engine/graph/enlargement.h"
#include "engine/graph/frame_graph.h"
#include "engine/graph/state_visitor.h"
#include "engine/vulkan/device.h"
#include "shared/specular/specular_estimates.h"

namespace patina {

/// Versions of the estimates' buffers within one frame.
struct SpecularEstimateIds {
    graph::BufferId means;      ///< gpu::PerceptualMaterial per label: the mean of all estimates so far
    graph::BufferId materials;  ///< gpu::WardMaterial per label: the material that it means
};

/// What the network said of each segment, by label; zero for those that were never estimated. Lives as long as the
/// segments; specular/fuse_estimates.h fills it.
class SpecularEstimates {
  public:
    /// Throws Error when memory runs out.
    SpecularEstimates(vulkan::Device& device, uint32_t labels);

    /// Forgets all estimates; the first thing done with it.
    void reset(graph::FrameGraph& frame) const;

    /// Announces that there will be `labels` of them; new ones were never estimated.
    void enlarge(graph::Enlargement& enlargement, uint32_t labels);

    SpecularEstimateIds import(graph::FrameGraph& frame) const {
        return {frame.import(means_), frame.import(materials_)};
    }
    static void keep(graph::FrameGraph& frame, const SpecularEstimateIds& ids);

    void visit(graph::StateVisitor& visitor);

    uint32_t labels() const { return labels_; }
    uint64_t bytes() const { return means_->bytes() + materials_->bytes(); }

  private:
    uint32_t labels_;
    vulkan::BufferRef means_, materials_;
};

}  // namespace patina
