#include "passes/input/unproject_depth.h"

#include "shared/input/unproject_depth.h"
#include "spirv/shaders.h"

namespace patina {

UnprojectedDepth add_unproject_depth(graph::FrameGraph& frame, graph::ImageId depth_m, const gpu::Camera& camera,
                                     const DepthJump& jump) {
    constexpr const char* kPass = "input.unproject_depth";
    const Extent2D extent = frame.shape(depth_m).extent;
    const Extent2D camera_extent{camera.extent.x, camera.extent.y};
    if (extent != camera_extent) {
        throw Error("the pass '", kPass, "' got a depth image of ", extent, " from a camera of ", camera_extent);
    }
    auto pass = frame.compute(kPass, spirv::unproject_depth);
    pass.read("depth_m", depth_m);
    const graph::ImageId position_m = pass.create("position_m", {extent, vulkan::Format::kRgba32f});
    const graph::ImageId normal = pass.create("normal", {extent, vulkan::Format::kRgba16f});
    pass.push(gpu::UnprojectDepthParams{camera, jump.floor_m, jump.relative, 0, 0});
    pass.dispatch_covering(extent);
    return {position_m, normal};
}

}  // namespace patina
