#include "passes/photometry/estimate_gains.h"

#include <cmath>

#include "engine/core/error.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

void check(const GainSettings& settings) {
    const auto check_range = [](const char* name, double value, double least, double most) {
        if (!(value >= least && value <= most)) {
            throw Error("gains.", name, " is ", value, ", it must be ", least, " to ", most);
        }
    };
    check_range("max_angle_degrees", settings.max_angle_degrees, 0, 90);
    check_range("min_samples", settings.min_samples, 1, 1e9);
    check_range("leak", settings.leak, 0, 1);
}

graph::BufferId add_compare_colors(graph::FrameGraph& frame, const GainInputs& inputs, const GainSettings& settings) {
    const Extent2D cast = frame.common_extent({inputs.position_m, inputs.normal, inputs.model_color});
    const Extent2D color = frame.shape(inputs.color_linear).extent;
    const graph::BufferId empty =
        frame.fill(frame.create_buffer("photometry.histogram", gpu::kGainHistogramWords * sizeof(uint32_t)), 0);
    auto pass = frame.compute("photometry.compare_colors", spirv::compare_colors);
    pass.read("position_m", inputs.position_m).read("normal", inputs.normal);
    pass.read("model_color", inputs.model_color).read("color_linear", inputs.color_linear);
    const graph::BufferId histogram = pass.modify("Histogram", empty);
    gpu::CompareColorsParams params{};
    params.camera_m = glm::vec4(inputs.camera_m, 0);
    params.color_per_px = glm::vec2(color.width, color.height) / glm::vec2(cast.width, cast.height);
    params.least_cosine = static_cast<float>(std::cos(glm::radians(double{settings.max_angle_degrees})));
    pass.push(params).dispatch_covering(cast);
    return histogram;
}

}  // namespace

graph::BufferId add_estimate_gains(graph::FrameGraph& frame, const GainInputs& inputs, graph::BufferId gains,
                                   const GainSettings& settings) {
    check(settings);
    const graph::BufferId histogram = add_compare_colors(frame, inputs, settings);
    auto pass = frame.compute("photometry.settle_gains", spirv::settle_gains);
    pass.read("Histogram", histogram).push(gpu::SettleGainsParams{settings.min_samples, settings.leak});
    const graph::BufferId settled = pass.modify("Gains", gains);
    pass.dispatch(3);
    return settled;
}

graph::ImageId add_apply_gains(graph::FrameGraph& frame, graph::ImageId color_linear, graph::BufferId gains) {
    const Extent2D extent = frame.shape(color_linear).extent;
    auto pass = frame.compute("photometry.apply_gains", spirv::apply_gains);
    pass.read("Gains", gains).read("color_linear", color_linear);
    const graph::ImageId corrected = pass.create("corrected", {extent, vulkan::Format::kRgba16f});
    pass.dispatch_covering(extent);
    return corrected;
}

}  // namespace patina
