#include "passes/tracking/hide_highlights.h"

#include "shared/tracking/tracking.h"
#include "spirv/shaders.h"

namespace patina {

graph::ImageId add_hide_highlights(graph::FrameGraph& frame, const HighlightInputs& inputs, float most_share) {
    const Extent2D extent = frame.common_extent({inputs.color_linear, inputs.kd, inputs.light, inputs.rgb});
    auto pass = frame.compute("tracking.hide_highlights", spirv::hide_highlights);
    pass.read("color_linear", inputs.color_linear).read("kd", inputs.kd);
    pass.read("light", inputs.light).read("rgb", inputs.rgb);
    const graph::ImageId matte = pass.create("matte", {extent, vulkan::Format::kRgba16f});
    pass.push(gpu::HideHighlightsParams{{extent.width, extent.height}, most_share, 0});
    pass.dispatch_covering(extent);
    return matte;
}

}  // namespace patina
