#pragma once

#include "passes/input/input.h"

namespace patina::vulkan {
class Device;
}

namespace patina {

/// The converted pictures of one frame, on the device until the next frame's take their place: who learns a frame's
/// pose only when its graph has finished goes on with them in another graph, and uploads nothing again.
class KeptInput {
  public:
    explicit KeptInput(vulkan::Device& device) : device_(device) {}

    /// Uploads and converts a frame's pictures in place of those of the frame before. Throws Error as add_convert_depth
    /// and add_convert_color do, or for lack of memory.
    InputPictures add(graph::FrameGraph& frame, const DepthInput& depth, const ColorInput& color);

    /// The pictures of the frame that was added last.
    InputPictures import(graph::FrameGraph& frame) const { return {frame.import(depth_m_), frame.import(color_)}; }

    /// Of device memory.
    uint64_t bytes() const;

  private:
    vulkan::Device& device_;
    vulkan::ImageRef depth_m_, color_;  ///< null before the first frame
};

}  // namespace patina
