#include "passes/input/filter_depth.h"

#include <numbers>

#include "shared/input/filter_depth.h"
#include "spirv/shaders.h"

namespace patina {

graph::ImageId add_filter_depth(graph::FrameGraph& frame, graph::ImageId depth_m, const DepthFilter& filter) {
    constexpr const char* kPass = "input.filter_depth";
    const bool usable =
        filter.sigma_px > 0 && filter.sigma_floor_m > 0 && filter.sigma_linear >= 0 && filter.sigma_quadratic >= 0;
    if (!usable) {
        throw Error("the pass '", kPass, "' got sigmas without use: ", filter.sigma_px, " px, at least ",
                    filter.sigma_floor_m, " m, ", filter.sigma_linear, " z + ", filter.sigma_quadratic, " z^2");
    }
    const Extent2D extent = frame.shape(depth_m).extent;
    const float spatial_exponent = -0.5f * std::numbers::log2e_v<float> / (filter.sigma_px * filter.sigma_px);
    auto pass = frame.compute(kPass, spirv::filter_depth);
    pass.read("depth_m", depth_m);
    const graph::ImageId filtered_m = pass.create("filtered_m", {extent, vulkan::Format::kR32f});
    pass.push(gpu::FilterDepthParams{glm::uvec2(extent.width, extent.height), spatial_exponent, filter.sigma_floor_m,
                                     filter.sigma_linear, filter.sigma_quadratic, 0, 0});
    pass.dispatch_covering(extent);
    return filtered_m;
}

}  // namespace patina
