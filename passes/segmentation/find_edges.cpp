#include "passes/segmentation/find_edges.h"

#include <cmath>

#include "engine/core/error.h"
#include "shared/find_edges.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

void check_extent(const char* pass, Extent2D extent, const gpu::Camera& camera) {
    const Extent2D camera_extent{camera.extent.x, camera.extent.y};
    if (extent != camera_extent) {
        throw Error("the pass '", pass, "' got images of ", extent, " from a camera of ", camera_extent);
    }
}

}  // namespace

graph::ImageId add_choose_surface(graph::Frame& frame, const SurfaceInputs& inputs, const gpu::Camera& camera,
                                  const EdgeSettings& settings) {
    constexpr const char* kPass = "segmentation.choose_surface";
    const Extent2D extent =
        frame.common_extent({inputs.model_position_m, inputs.model_normal, inputs.depth_m, inputs.normal});
    check_extent(kPass, extent, camera);
    auto pass = frame.compute(kPass, spirv::choose_surface);
    pass.read("model_position_m", inputs.model_position_m).read("model_normal", inputs.model_normal);
    pass.read("depth_m", inputs.depth_m).read("normal", inputs.normal);
    const graph::ImageId surface = pass.create("surface", {extent, vulkan::Format::kRgba32f});
    pass.push(gpu::ChooseSurfaceParams{camera, settings.noise.floor_m, settings.noise.per_m, settings.agreement_floor_m,
                                       settings.agreement_sigmas});
    pass.dispatch_covering(extent);
    return surface;
}

graph::ImageId add_find_edges(graph::Frame& frame, graph::ImageId surface, const gpu::Camera& camera,
                              const EdgeSettings& settings) {
    constexpr const char* kPass = "segmentation.find_edges";
    const Extent2D extent = frame.shape(surface).extent;
    check_extent(kPass, extent, camera);
    if (settings.min_reach_px == 0 || settings.min_reach_px > settings.max_reach_px) {
        throw Error("the pass '", kPass, "' compares pixels from ", settings.min_reach_px, " to ",
                    settings.max_reach_px, " px apart; it needs 1 at least, and the second no smaller");
    }
    gpu::FindEdgesParams params{};
    params.focal_center_px = camera.focal_center_px;
    params.extent = camera.extent;
    params.noise_floor_m = settings.noise.floor_m;
    params.noise_per_m = settings.noise.per_m;
    params.reach_px_m = settings.reach_m * camera.focal_center_px.x;
    params.min_reach_px = static_cast<float>(settings.min_reach_px);
    params.max_reach_px = static_cast<float>(settings.max_reach_px);
    params.step_floor_m = settings.step_floor_m;
    params.step_sigmas = settings.step_sigmas;
    params.crease_cosine = std::cos(glm::radians(settings.crease_degrees));
    auto pass = frame.compute(kPass, spirv::find_edges);
    pass.read("surface", surface);
    const graph::ImageId inner_depth_m = pass.create("inner_depth_m", {extent, vulkan::Format::kR32f});
    pass.push(params).dispatch_covering(extent);
    return inner_depth_m;
}

}  // namespace patina
