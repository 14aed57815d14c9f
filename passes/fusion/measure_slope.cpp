#include "passes/fusion/measure_slope.h"

#include "engine/core/error.h"
#include "shared/fusion/slope.h"
#include "spirv/shaders.h"

namespace patina {

graph::ImageId add_measure_slope(graph::FrameGraph& frame, graph::ImageId smooth_depth_m, const Intrinsics& camera) {
    const Extent2D extent = frame.shape(smooth_depth_m).extent;
    if (extent != camera.extent) {
        throw Error("the pass 'fusion.measure_slope' got a depth image of ", extent, " pixels, its camera has ",
                    camera.extent);
    }
    gpu::SlopeParams params{};
    params.focal_center_px = glm::vec4(camera.fx, camera.fy, camera.cx, camera.cy);
    params.extent = {extent.width, extent.height};
    // Between neighbouring pixels a surface inclined by 75 degrees changes by 1 % of its depth at Kinect-like focal
    // lengths; jumps between objects are larger.
    params.jump_m = 0.01f;
    params.jump_slope = 0.015f;
    auto pass = frame.compute("fusion.measure_slope", spirv::measure_slope);
    pass.read("smooth_depth_m", smooth_depth_m).push(params);
    const graph::ImageId slope = pass.create("slope", {extent, vulkan::Format::kR32u});
    pass.dispatch_covering(extent);
    return slope;
}

}  // namespace patina
