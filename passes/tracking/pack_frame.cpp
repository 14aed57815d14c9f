#include "passes/tracking/pack_frame.h"

#include "engine/core/error.h"
#include "engine/core/shader_camera.h"
#include "passes/tracking/no_color.h"
#include "shared/tracking/tracking.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

void check_extent(const graph::FrameGraph& frame, const char* pass, graph::ImageId image, const Intrinsics& camera) {
    const Extent2D extent = frame.shape(image).extent;
    if (extent != camera.extent) {
        throw Error("the pass '", pass, "' got an image of ", extent, " pixels, its camera has ", camera.extent);
    }
}

Intrinsics checked_half(const char* pass, const Intrinsics& camera) {
    const Intrinsics half = halved(camera);
    if (half.extent.area() == 0)
        throw Error("the pass '", pass, "' cannot halve an image of ", camera.extent, " pixels");
    return half;
}

}  // namespace

TrackLevel add_pack_frame(graph::FrameGraph& frame, graph::ImageId depth_m, const Intrinsics& camera,
                          const std::optional<TrackColor>& color, float max_depth_m, bool half, const TrackJump& jump) {
    constexpr const char* kPass = "tracking.pack_frame";
    check_extent(frame, kPass, depth_m, camera);
    Intrinsics result = half ? checked_half(kPass, camera) : camera;
    result.distortion = {};
    gpu::PackFrameParams params{};
    params.focal_center_px = glm::vec4(camera.fx, camera.fy, camera.cx, camera.cy);
    params.jump_m = jump.floor_m;
    params.jump_slope = jump.slope;
    params.max_depth_m = max_depth_m;
    graph::ImageId color_linear;
    if (color) {
        check_extent(frame, kPass, color->color_linear, color->camera);
        params.color_camera = make_camera(color->camera, rigid_inverse(color->color_from_depth));
        params.shaded = 1;
        color_linear = color->color_linear;
    } else {
        color_linear = no_color(frame);
    }
    auto pass = frame.compute(kPass, spirv::pack_frame);
    pass.read("depth_m", depth_m).read("color_linear", color_linear).push(params);
    pass.specialise("kSide", half ? 2 : 1);
    const graph::ImageId packed = pass.create("packed", {result.extent, vulkan::Format::kR32u});
    pass.dispatch_covering(result.extent);
    return {packed, result};
}

TrackLevel add_halve_frame(graph::FrameGraph& frame, const TrackLevel& fine, const TrackJump& jump) {
    constexpr const char* kPass = "tracking.halve_frame";
    const Intrinsics camera = checked_half(kPass, fine.camera);
    auto pass = frame.compute(kPass, spirv::halve_frame);
    pass.read("fine", fine.pixels);
    pass.push(gpu::HalveParams{{camera.extent.width, camera.extent.height}, jump.floor_m, 2 * jump.slope});
    const graph::ImageId coarse = pass.create("coarse", {camera.extent, vulkan::Format::kR32u});
    pass.dispatch_covering(camera.extent);
    return {coarse, camera};
}

}  // namespace patina
