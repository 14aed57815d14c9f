#pragma once

#include <deque>
#include <vector>

#include "engine/vulkan/device.h"
#include "passes/fusion/raycast.h"
#include "passes/photometry/estimate_gains.h"
#include "reconstruction/frame_context.h"

namespace patina {

/// Brings a frame's colours to the exposure and white balance of the first frame, where the camera changed these by
/// itself: estimates the frame's gains against the model as it was before, and divides by them. Lives as long as the
/// map that holds the model.
class ColorCorrection {
  public:
    /// Throws Error when memory runs out.
    ColorCorrection(vulkan::Device& device, const VoxelMap& map, const GainSettings& settings, MapAccess access);

    /// Sets the gains to 1 and forgets those so far; the first thing done with it.
    void reset(graph::FrameGraph& graph);

    /// Estimates the gains of a frame whose linear colours are `color_linear`, before it is fused. Returns the colours
    /// divided by them.
    graph::ImageId add(graph::FrameGraph& graph, const VoxelMapIds& ids, graph::ImageId color_linear,
                       const FrameContext& frame);

    /// Of the frames so far, in order; of all but the last two at once, of all after Runner::wait().
    const std::vector<gpu::ColorGains>& gains();

    void visit(graph::StateVisitor& visitor);

  private:
    const VoxelMap& map_;
    GainSettings settings_;
    MapAccess access_;
    vulkan::BufferRef last_;  ///< gpu::ColorGains
    std::deque<graph::Readback> pending_;
    std::vector<gpu::ColorGains> gains_;
};

}  // namespace patina
