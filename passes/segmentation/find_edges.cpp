#include "passes/segmentation/find_edges.h"

#include <cmath>

#include "engine/core/error.h"
#include "shared/choose_depth.h"
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
                                            uint32_t min_pixels) {
    if (settings.min_reach_px == 0 || settings.min_reach_px > settings.max_reach_px) {
        throw Error("normals are compared from ", settings.min_reach_px, " to ", settings.max_reach_px,
                    " px apart; it must be 1 at least, and the second no smaller");
    }
    gpu::FrameSurfaceParams params{};
    params.focal_center_px = camera.focal_center_px;
    params.extent = camera.extent;
    params.jump_m = settings.jump_m;
    params.jump_slope = std::tan(glm::radians(settings.steepest_degrees)) / camera.focal_center_px.x;
    params.noise_floor_m = settings.noise.floor_m;
    params.noise_per_m = settings.noise.per_m;
    params.reach_px_m = settings.reach_m * camera.focal_center_px.x;
    params.min_reach_px = static_cast<float>(settings.min_reach_px);
    params.max_reach_px = static_cast<float>(settings.max_reach_px);
    params.crease_rad = glm::radians(settings.crease_degrees);
    params.crease_sigmas = settings.crease_sigmas;
    params.step_m = settings.step_m;
    params.step_sigmas = settings.step_sigmas;
    params.cut_chroma = settings.cut_chroma;
    params.cut_light = settings.cut_light;
    params.claim_m = settings.claim_m;
    params.claim_sigmas = settings.claim_sigmas;
    params.claim_reach_px = static_cast<int>(settings.claim_reach_px);
    params.min_pixels = min_pixels;
    return params;
}

FrameSurface add_choose_depth(graph::Frame& frame, graph::ImageId model_position_m, graph::ImageId reading_m,
                              const gpu::Camera& camera, const ColorPicture& color) {
    const Extent2D extent = frame.common_extent({model_position_m, reading_m});
    const gpu::ChooseDepthParams params{color.camera.camera_from_world * glm::inverse(camera.camera_from_world),
                                        camera.focal_center_px,
                                        color.camera.focal_center_px,
                                        {extent.width, extent.height},
                                        0,
                                        0};
    auto pass = frame.compute("segmentation.choose_depth", spirv::choose_depth);
    pass.read("model_position_m", model_position_m).read("reading_m", reading_m);
    pass.read("color_linear", color.color_linear).push(params);
    const FrameSurface surface{pass.create("depth_m", {extent, vulkan::Format::kR32f}),
                               pass.create("chroma", {extent, vulkan::Format::kR32u})};
    pass.dispatch_covering(extent);
    return surface;
}

graph::ImageId add_fit_normals(graph::Frame& frame, graph::ImageId depth_m, const gpu::FrameSurfaceParams& params) {
    constexpr const char* kPass = "segmentation.fit_normals";
    const Extent2D extent = checked_extent(kPass, frame.shape(depth_m).extent, params);
    auto pass = frame.compute(kPass, spirv::fit_normals);
    pass.read("depth_m", depth_m);
    const graph::ImageId normal = pass.create("normal", {extent, vulkan::Format::kR32u});
    pass.push(params).dispatch_covering(extent);
    return normal;
}

graph::ImageId add_find_edges(graph::Frame& frame, const FrameSurface& surface, graph::ImageId normal,
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
