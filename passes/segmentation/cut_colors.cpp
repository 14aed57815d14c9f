#include "passes/segmentation/cut_colors.h"

#include "shared/cut_colors.h"
#include "spirv/shaders.h"

namespace patina {

graph::ImageId add_cut_colors(graph::Frame& frame, graph::ImageId inner_depth_m, const gpu::Camera& depth_camera,
                              const ColorGuide& guide) {
    const Extent2D extent = frame.shape(inner_depth_m).extent;
    gpu::CutColorsParams params{};
    params.color_from_depth = guide.camera.camera_from_world * glm::inverse(depth_camera.camera_from_world);
    params.depth_focal_center_px = depth_camera.focal_center_px;
    params.color_focal_center_px = guide.camera.focal_center_px;
    params.extent = {extent.width, extent.height};
    params.chroma = guide.chroma;
    params.reach_px = guide.reach_px;
    params.same_chroma = guide.same_chroma;
    params.strong_chroma = guide.strong_chroma;
    auto pass = frame.compute("segmentation.cut_colors", spirv::cut_colors);
    pass.read("inner_depth_m", inner_depth_m).read("color_linear", guide.color_linear).push(params);
    const graph::ImageId cut = pass.create("cut_depth_m", {extent, vulkan::Format::kR32f});
    pass.dispatch_covering(extent);
    return cut;
}

}  // namespace patina
