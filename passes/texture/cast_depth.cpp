#include "passes/texture/cast_depth.h"

#include "spirv/shaders.h"

namespace patina {

graph::ImageId add_cast_depth(graph::FrameGraph& frame, graph::ImageId position_m,
                              std::optional<graph::ImageId> target) {
    const Extent2D extent = target ? frame.common_extent({position_m, *target}) : frame.shape(position_m).extent;
    auto pass = frame.compute("texture.cast_depth", spirv::cast_depth);
    pass.read("position_m", position_m);
    const graph::ImageId depth_m =
        target ? pass.write("depth_m", *target) : pass.create("depth_m", {extent, vulkan::Format::kR32f});
    pass.dispatch_covering(extent);
    return depth_m;
}

}  // namespace patina
