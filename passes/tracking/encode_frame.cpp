#include "passes/tracking/encode_frame.h"

#include <numbers>

#include "engine/core/error.h"
#include "shared/tracking/keyframes.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

constexpr Extent2D kSmall{gpu::kSmallWidth, gpu::kSmallHeight};
constexpr float kSigma_px = 2.5f;
constexpr int kRadius_px = 7;  // 2.8 sigma

graph::ImageId add_smooth(graph::FrameGraph& frame, graph::ImageId boxes) {
    auto pass = frame.compute("tracking.smooth_frame", spirv::smooth_frame);
    pass.read("boxes", boxes);
    const graph::ImageId smoothed = pass.create("smoothed", {kSmall, vulkan::Format::kRgba32f});
    const float exponent_per_px2 = -0.5f * std::numbers::log2e_v<float> / (kSigma_px * kSigma_px);
    pass.push(gpu::SmoothFrameParams{exponent_per_px2, kRadius_px}).dispatch_covering(kSmall);
    return smoothed;
}

}  // namespace

graph::ImageId add_shrink_frame(graph::FrameGraph& frame, graph::ImageId depth_m, graph::ImageId color) {
    const Extent2D depth_px = frame.shape(depth_m).extent, color_px = frame.shape(color).extent;
    auto pass = frame.compute("tracking.shrink_frame", spirv::shrink_frame);
    pass.read("depth_m", depth_m).read("color", color);
    const graph::ImageId boxes = pass.create("boxes", {kSmall, vulkan::Format::kRgba32f});
    pass.push(gpu::ShrinkFrameParams{{depth_px.width, depth_px.height}, {color_px.width, color_px.height}});
    pass.dispatch_covering(kSmall);
    return add_smooth(frame, boxes);
}

graph::BufferId add_encode_frame(graph::FrameGraph& frame, graph::ImageId small, graph::BufferId ferns) {
    if (const Extent2D extent = frame.shape(small).extent; extent != kSmall) {
        throw Error("the pass 'tracking.encode_ferns' got a picture of ", extent, " pixels, it must be ", kSmall);
    }
    auto pass = frame.compute("tracking.encode_ferns", spirv::encode_ferns);
    pass.read("picture", small).read("Ferns", ferns);
    const graph::BufferId code = pass.create("Code", gpu::kFernWords * sizeof(uint32_t));
    pass.dispatch_covering(gpu::kFernWords);
    return code;
}

}  // namespace patina
