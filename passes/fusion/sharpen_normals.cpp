#include "passes/fusion/sharpen_normals.h"

#include "shared/fusion/sharpen_normals.h"
#include "spirv/shaders.h"

namespace patina {

RaycastImages add_sharpen_normals(graph::FrameGraph& frame, const RaycastImages& model, float focal_px, float voxel_m) {
    const Extent2D extent = frame.common_extent({model.position_m, model.normal});
    auto pass = frame.compute("fusion.sharpen_normals", spirv::sharpen_normals);
    pass.read("position_m", model.position_m).read("normal", model.normal);
    RaycastImages sharp = model;
    sharp.normal = pass.create("sharp_normal", {extent, vulkan::Format::kRgba16f});
    pass.push(gpu::SharpenNormalsParams{focal_px, voxel_m});
    pass.dispatch_covering(extent);
    return sharp;
}

}  // namespace patina
