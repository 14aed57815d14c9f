#include "passes/tracking/pack_model.h"

#include "engine/core/error.h"
#include "passes/tracking/no_color.h"
#include "shared/tracking/tracking.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

constexpr float kLeastCosine = 0.17f;  // 80 degrees; beyond, a pixel's depth says little of its plane

void check_half(const char* pass, Extent2D whole, Extent2D half) {
    if (half != Extent2D{whole.width / 2, whole.height / 2} || half.area() == 0) {
        throw Error("the pass '", pass, "' got an image of ", whole, " pixels and one of ", half, " for its half");
    }
}

}  // namespace

graph::ImageId add_pack_model(graph::FrameGraph& frame, const TrackModelInputs& inputs, graph::ImageId target,
                              const TrackJump& jump) {
    const Extent2D whole = frame.common_extent({inputs.surface.position_m, inputs.surface.normal});
    const Extent2D extent = frame.shape(target).extent;
    const bool half = extent != whole;
    if (half) check_half("tracking.pack_model", whole, extent);
    gpu::PackModelParams params{};
    params.camera = inputs.camera;
    params.jump_m = jump.floor_m;
    params.jump_slope = jump.slope;
    params.least_cosine = kLeastCosine;
    params.shaded = inputs.color_linear ? 1 : 0;
    const graph::ImageId color_linear = inputs.color_linear ? *inputs.color_linear : no_color(frame);
    auto pass = frame.compute("tracking.pack_model", spirv::pack_model);
    pass.read("position_m", inputs.surface.position_m).read("normal", inputs.surface.normal);
    pass.read("color_linear", color_linear).push(params);
    pass.specialise("kSide", half ? 2 : 1);
    const graph::ImageId packed = pass.write("packed", target);
    pass.dispatch_covering(extent);
    return packed;
}

graph::ImageId add_halve_model(graph::FrameGraph& frame, graph::ImageId fine, graph::ImageId target,
                               const TrackJump& jump) {
    constexpr const char* kPass = "tracking.halve_model";
    const Extent2D extent = frame.shape(target).extent;
    check_half(kPass, frame.shape(fine).extent, extent);
    auto pass = frame.compute(kPass, spirv::halve_model);
    pass.read("fine", fine);
    pass.push(gpu::HalveParams{{extent.width, extent.height}, jump.floor_m, 2 * jump.slope});
    const graph::ImageId coarse = pass.write("coarse", target);
    pass.dispatch_covering(extent);
    return coarse;
}

}  // namespace patina
