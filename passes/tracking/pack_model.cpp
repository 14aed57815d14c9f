#include "passes/tracking/pack_model.h"

#include <algorithm>

#include "engine/core/error.h"
#include "passes/tracking/no_color.h"
#include "shared/tracking.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

constexpr float kLeastCosine = 0.17f;  // 80 degrees; beyond, a pixel's depth says little of its plane

}  // namespace

graph::ImageId add_pack_model(graph::Frame& frame, const TrackModelInputs& inputs, uint32_t stride,
                              graph::ImageId target, const TrackJump& jump) {
    const Extent2D whole = frame.common_extent({inputs.surface.position_m, inputs.surface.normal});
    const Extent2D extent = frame.shape(target).extent;
    if (extent != Extent2D{whole.width / stride, whole.height / stride} || extent.area() == 0) {
        throw Error("the pass 'tracking.pack_model' got an image of ", whole, " pixels and one of ", extent,
                    " for every ", stride, ". of them");
    }
    gpu::PackModelParams params{};
    params.extent = {extent.width, extent.height};
    params.stride = static_cast<int>(stride);
    params.reach = std::max(params.stride / 2, 1);
    params.camera = inputs.camera;
    params.jump_m = jump.floor_m;
    params.jump_slope = jump.slope;
    params.least_cosine = kLeastCosine;
    params.shaded = inputs.color_linear ? 1 : 0;
    const graph::ImageId color_linear = inputs.color_linear ? *inputs.color_linear : no_color(frame);
    auto pass = frame.compute("tracking.pack_model", spirv::pack_model);
    pass.read("position_m", inputs.surface.position_m).read("normal", inputs.surface.normal);
    pass.read("color_linear", color_linear).push(params);
    const graph::ImageId packed = pass.write("packed", target);
    pass.dispatch_covering(extent);
    return packed;
}

graph::ImageId add_halve_model(graph::Frame& frame, graph::ImageId fine, graph::ImageId target, const TrackJump& jump) {
    const Extent2D whole = frame.shape(fine).extent, extent = frame.shape(target).extent;
    if (extent != Extent2D{whole.width / 2, whole.height / 2} || extent.area() == 0) {
        throw Error("the pass 'tracking.halve_model' got an image of ", whole, " pixels and one of ", extent,
                    " for its half");
    }
    auto pass = frame.compute("tracking.halve_model", spirv::halve_model);
    pass.read("fine", fine);
    pass.push(gpu::HalveParams{{extent.width, extent.height}, jump.floor_m, 2 * jump.slope});
    const graph::ImageId coarse = pass.write("coarse", target);
    pass.dispatch_covering(extent);
    return coarse;
}

}  // namespace patina
