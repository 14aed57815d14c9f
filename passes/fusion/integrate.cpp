#include "passes/fusion/integrate.h"

#include "spirv/shaders.h"

namespace patina {

void add_integrate(graph::Frame& frame, const VoxelMap& map, VoxelMapIds& ids, const VisibleBlocks& visible,
                   graph::BufferId params, graph::ImageId depth_m, graph::ImageId slope,
                   std::optional<graph::ImageId> color_linear) {
    auto pass = frame.compute("fusion.integrate", color_linear ? spirv::integrate_color : spirv::integrate);
    pass.read("Visible", visible.list)
        .read("BlockKeys", ids.block_keys)
        .read("Fusion", params)
        .read("depth_m", depth_m)
        .read("slope", slope);
    pass.specialise("kVoxelChunks", map.chunks());
    ids.tsdf = pass.modify("Tsdf", ids.tsdf);
    if (color_linear) {
        pass.read("color_linear", *color_linear);
        ids.color = pass.modify("Color", ids.color);
    }
    pass.dispatch_indirect(visible.arguments);
}

}  // namespace patina
