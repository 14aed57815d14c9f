#include "passes/fusion/shade_color.h"

#include "spirv/shaders.h"

namespace patina {

graph::ImageId add_shade_color(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& ids,
                               const VisibleBlocks& visible, graph::ImageId position_m) {
    const Extent2D extent = frame.shape(position_m).extent;
    auto pass = frame.compute("fusion.shade_color", spirv::shade_color);
    pass.read("position_m", position_m)
        .read("View", visible.view)
        .read("ViewGrid", visible.grid)
        .read("Color", ids.color);
    pass.specialise("kVoxelChunks", map.chunks());
    const graph::ImageId color = pass.create("color_linear", {extent, vulkan::Format::kRgba16f});
    pass.dispatch_covering(extent);
    return color;
}

}  // namespace patina
