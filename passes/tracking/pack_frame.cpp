#include "passes/tracking/pack_frame.h"

#include "engine/core/error.h"
#include "engine/core/shader_camera.h"
#include "passes/tracking/no_color.h"
#include "shared/tracking.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

void check_extent(const graph::Frame& frame, const char* pass, graph::ImageId image, const Intrinsics& camera) {
    const Extent2D extent = frame.shape(image).extent;
    if (extent != camera.extent) {
        throw Error("the pass '", pass, "' got an image of ", extent, " pixels, its camera has ", camera.extent);
    }
}

}  // namespace

TrackLevel add_pack_frame(graph::Frame& frame, graph::ImageId depth_m, const Intrinsics& camera,
                          const std::optional<TrackColor>& color, float max_depth_m, const TrackJump& jump) {
    constexpr const char* kPass = "tracking.pack_frame";
    check_extent(frame, kPass, depth_m, camera);
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
    const graph::ImageId packed = pass.create("packed", {camera.extent, vulkan::Format::kR32u});
    pass.dispatch_covering(camera.extent);
    Intrinsics pinhole = camera;
    pinhole.distortion = {};
    return {packed, pinhole};
}

TrackLevel add_halve_frame(graph::Frame& frame, const TrackLevel& fine, const TrackJump& jump) {
    const Intrinsics camera = halved(fine.camera);
    if (camera.extent.area() == 0) {
        throw Error("the pass 'tracking.halve_frame' cannot halve an image of ", fine.camera.extent, " pixels");
    }
    auto pass = frame.compute("tracking.halve_frame", spirv::halve_frame);
    pass.read("fine", fine.pixels);
    pass.push(gpu::HalveParams{{camera.extent.width, camera.extent.height}, jump.floor_m, 2 * jump.slope});
    const graph::ImageId coarse = pass.create("coarse", {camera.extent, vulkan::Format::kR32u});
    pass.dispatch_covering(camera.extent);
    return {coarse, camera};
}

}  // namespace patina
