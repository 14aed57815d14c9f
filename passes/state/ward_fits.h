#pragma once

#include <cstdint>

#include "engine/graph/enlargement.h"
#include "engine/graph/frame_graph.h"
#include "engine/graph/state_visitor.h"
#include "engine/vulkan/device.h"
#include "shared/specular/mirror_fit.h"

namespace patina {

/// Versions of the fits' buffers within one frame.
struct WardFitIds {
    graph::BufferId fits;      ///< gpu::WardFit per label
    graph::BufferId curves;    ///< gpu::FitCurve[gpu::kFitAlphas] per label
    graph::BufferId progress;  ///< gpu::SegmentProgress per label
    graph::BufferId mirrors;   ///< gpu::MirrorFit per label
};

/// What the observations of each segment told about its specular material so far, by label. Lives as long as the
/// segments; specular/fit_ward.h fills it.
class WardFits {
  public:
    /// How many labels a device's buffers have room for.
    static uint32_t most_labels(const vulkan::DeviceCaps& caps);

    /// Throws Error when memory runs out.
    WardFits(vulkan::Device& device, uint32_t labels);

    /// Forgets all; the first thing done with it.
    void reset(graph::FrameGraph& frame) const;
    /// Forgets all but what is known of mirrors.
    void forget_gloss(graph::FrameGraph& frame) const;

    /// Announces that there will be `labels` of them; of new ones nothing is known.
    void enlarge(graph::Enlargement& enlargement, uint32_t labels);

    WardFitIds import(graph::FrameGraph& frame) const {
        return {frame.import(fits_), frame.import(curves_), frame.import(progress_), frame.import(mirrors_)};
    }
    static void keep(graph::FrameGraph& frame, const WardFitIds& ids);

    void visit(graph::StateVisitor& visitor);

    uint32_t labels() const { return labels_; }
    uint64_t bytes() const { return fits_->bytes() + curves_->bytes() + progress_->bytes() + mirrors_->bytes(); }

  private:
    uint32_t labels_;
    vulkan::BufferRef fits_, curves_, progress_, mirrors_;
};

}  // namespace patina
