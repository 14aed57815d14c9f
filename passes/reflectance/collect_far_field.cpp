#include "passes/reflectance/collect_far_field.h"

#include "spirv/shaders.h"

namespace patina {

namespace {

constexpr uint32_t kFarStride_px = 8;

gpu::FarFieldParams make_params(const FarFieldInputs& inputs, Extent2D extent) {
    gpu::FarFieldParams params{};
    params.depth_camera = inputs.depth_camera;
    params.color_camera = inputs.color_camera;
    params.visited = (glm::uvec2(extent.width, extent.height) + kFarStride_px - 1u) / kFarStride_px;
    params.stride_px = kFarStride_px;
    // 37 shares no factor with 64: frames beside each other look at pixels that are apart.
    params.phase = inputs.frame_index * 37 % (kFarStride_px * kFarStride_px);
    return params;
}

}  // namespace

void add_collect_far_field(graph::FrameGraph& frame, ReflectanceStateIds& state, const FarFieldInputs& inputs) {
    if (inputs.frame_index >= kMostFarFieldFrames) return;
    const Extent2D extent = frame.common_extent({inputs.position_m, inputs.depth_m});
    const gpu::FarFieldParams params = make_params(inputs, extent);
    auto pass = frame.compute("reflectance.collect_far_field", spirv::collect_far_field);
    pass.read("position_m", inputs.position_m).read("depth_m", inputs.depth_m);
    pass.read("color_linear", inputs.color_linear);
    pass.read("Params", frame.upload<gpu::FarFieldParams>("far_field_params", std::span(&params, 1)));
    state.surroundings = pass.modify("FarField", state.surroundings);
    pass.dispatch_covering({params.visited.x, params.visited.y});
}

}  // namespace patina
