#include "passes/tracking/no_color.h"

namespace patina {

graph::ImageId no_color(graph::FrameGraph& frame) {
    constexpr uint64_t kBlack = 0;
    return frame.upload("tracking.no_color", {{1, 1}, vulkan::Format::kRgba16f}, std::as_bytes(std::span(&kBlack, 1)));
}

}  // namespace patina
