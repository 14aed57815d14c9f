#include "passes/reflectance/collect_surroundings.h"

#include "spirv/shaders.h"

namespace patina {

namespace {

constexpr uint32_t kNearStride_px = 4;

gpu::SurroundingsParams make_params(const SurroundingsInputs& inputs, Extent2D extent) {
    gpu::SurroundingsParams params{};
    params.depth_camera = inputs.depth_camera;
    params.color_camera = inputs.color_camera;
    params.visited = (glm::uvec2(extent.width, extent.height) + kNearStride_px - 1u) / kNearStride_px;
    params.stride_px = kNearStride_px;
    // 7 shares no factor with 16: frames beside each other look at pixels that are apart.
    params.phase = inputs.frame_index * 7 % (kNearStride_px * kNearStride_px);
    params.radiance_scale = inputs.radiance_scale;
    params.lamp_luminance = inputs.lamp_luminance;
    return params;
}

}  // namespace

void add_collect_surroundings(graph::FrameGraph& frame, ReflectanceStateIds& state, const SurroundingsInputs& inputs) {
    if (inputs.frame_index >= (inputs.radiance_scale > 0 ? kMostLowExposures : kMostSurroundingsFrames)) return;
    const gpu::SurroundingsParams params = make_params(inputs, frame.common_extent({inputs.depth_m}));
    auto count = frame.compute("reflectance.count_surroundings", spirv::count_surroundings);
    state.surroundings = count.modify("Surroundings", state.surroundings);
    count.dispatch(1);
    auto pass = frame.compute("reflectance.collect_surroundings", spirv::collect_surroundings);
    pass.read("depth_m", inputs.depth_m).read("color_linear", inputs.color_linear);
    pass.read("Params", frame.upload<gpu::SurroundingsParams>("surroundings_params", std::span(&params, 1)));
    state.surroundings = pass.modify("Surroundings", state.surroundings);
    pass.specialise("kLowExposure", inputs.radiance_scale > 0 ? 1u : 0u);
    pass.dispatch_covering({params.visited.x, params.visited.y});
    const gpu::OpeningParams turn{inputs.frame_index % gpu::kOpeningTurns};
    auto find = frame.compute("reflectance.fill_openings", spirv::fill_openings);
    state.surroundings = find.modify("Surroundings", state.surroundings);
    find.push(turn).dispatch(gpu::kOpeningTexels / gpu::kOpeningTurns / gpu::kOpeningGroup);
}

}  // namespace patina
