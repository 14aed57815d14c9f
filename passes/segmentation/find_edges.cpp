#include "passes/segmentation/find_edges.h"

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "shared/input/choose_depth.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

Extent2D checked_extent(const char* pass, Extent2D extent, const gpu::FrameSurfaceParams& params) {
    const Extent2D camera{params.extent.x, params.extent.y};
    if (extent != camera) throw Error("the pass '", pass, "' got images of ", extent, " from a camera of ", camera);
    return extent;
}

}  // namespace

gpu::FrameSurfaceParams make_surface_params(const gpu::Camera& camera, const EdgeSettings& settings,
                                            uint32_t min_pixels, uint32_t stride_px) {
    if (stride_px == 0) throw Error("every 0th pixel of a frame is to be looked at, it must be 1 at least");
    if (settings.min_reach_px == 0 || settings.min_reach_px > settings.max_reach_px) {
        throw Error("normals are compared from ", settings.min_reach_px, " to ", settings.max_reach_px,
                    " px apart; it must be 1 at least, and the second no smaller");
    }
    gpu::FrameSurfaceParams params{};
    const Extent2D looked_at = sampled_extent({camera.extent.x, camera.extent.y}, stride_px);
    const auto in_steps = [&](uint32_t px) { return std::max(px / stride_px, 1u); };
    params.focal_center_px = camera.focal_center_px / static_cast<float>(stride_px);
    params.extent = {looked_at.width, looked_at.height};
    params.jump_m = settings.jump_m;
    params.jump_slope = std::tan(glm::radians(settings.steepest_degrees)) / params.focal_center_px.x;
    params.noise_floor_m = settings.noise.floor_m;
    params.noise_per_m = settings.noise.per_m;
    params.reach_px_m = settings.reach_m * params.focal_center_px.x;
    params.min_reach_px = static_cast<float>(in_steps(settings.min_reach_px));
    params.max_reach_px = static_cast<float>(in_steps(settings.max_reach_px));
    params.crease_rad = glm::radians(settings.crease_degrees);
    params.crease_sigmas = settings.crease_sigmas;
    params.step_m = settings.step_m;
    params.step_sigmas = settings.step_sigmas;
    params.cut_chroma = settings.cut_chroma;
    params.cut_light = settings.cut_light;
    params.claim_m = settings.claim_m;
    params.claim_sigmas = settings.claim_sigmas;
    params.claim_reach_px = static_cast<int>(in_steps(settings.claim_reach_px));
    params.min_pixels = (min_pixels + stride_px * stride_px - 1) / (stride_px * stride_px);
    params.color_reach_px = static_cast<int>(in_steps(settings.color_reach_px));
    return params;
}

FrameSurface add_choose_depth(graph::FrameGraph& frame, graph::ImageId model_position_m, graph::ImageId reading_m,
                              const gpu::Camera& camera, const ColorPicture& color, uint32_t stride_px) {
    const Extent2D extent = frame.common_extent({model_position_m, reading_m});
    const Extent2D looked_at = sampled_extent(extent, stride_px);
    const gpu::ChooseDepthParams params{color.camera.camera_from_world * glm::inverse(camera.camera_from_world),
                                        camera.focal_center_px,
                                        color.camera.focal_center_px,
                                        {extent.width, extent.height},
                                        0,
                                        0};
    auto pass = frame.compute("segmentation.choose_depth", spirv::choose_depth);
    pass.read("model_position_m", model_position_m).read("reading_m", reading_m);
    pass.read("color_linear", color.color_linear).push(params).specialise("kStride", stride_px);
    const FrameSurface surface{pass.create("depth_m", {looked_at, vulkan::Format::kR32f}),
                               pass.create("chroma", {looked_at, vulkan::Format::kR32u})};
    pass.dispatch_covering(looked_at);
    return surface;
}

graph::ImageId add_fit_normals(graph::FrameGraph& frame, graph::ImageId depth_m,
                               const gpu::FrameSurfaceParams& params) {
    constexpr const char* kPass = "segmentation.fit_normals";
    const Extent2D extent = checked_extent(kPass, frame.shape(depth_m).extent, params);
    auto pass = frame.compute(kPass, spirv::fit_normals);
    pass.read("depth_m", depth_m);
    const graph::ImageId normal = pass.create("normal", {extent, vulkan::Format::kR32u});
    pass.push(params).dispatch_covering(extent);
    return normal;
}

graph::ImageId add_find_edges(graph::FrameGraph& frame, const FrameSurface& surface, graph::ImageId normal,
                              const gpu::FrameSurfaceParams& params) {
    constexpr const char* kPass = "segmentation.find_edges";
    const Extent2D extent =
        checked_extent(kPass, frame.common_extent({surface.depth_m, surface.chroma, normal}), params);
    auto pass = frame.compute(kPass, spirv::find_edges);
    pass.read("depth_m", surface.depth_m).read("normal", normal).read("chroma", surface.chroma);
    const graph::ImageId inner_depth_m = pass.create("inner_depth_m", {extent, vulkan::Format::kR32f});
    pass.push(params).dispatch_covering(extent);
    return inner_depth_m;
}

}  // namespace patina
