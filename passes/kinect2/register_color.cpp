#include "passes/kinect2/register_color.h"

#include "engine/core/error.h"
#include "spirv/shaders.h"

namespace patina::kinect2 {

graph::ImageId add_register_color(graph::FrameGraph& frame, const Tables& tables, const TableIds& ids,
                                  graph::ImageId depth_m, std::span<const SrgbPixel> color) {
    constexpr const char* kPass = "kinect2.register_color";
    constexpr float kTolerance = 0.01f;  // libfreenect2's registration.cpp
    if (color.size() != kColorExtent.area())
        throw Error("the pass '", kPass, "' got ", color.size(), " pixels for a picture of ", kColorExtent);
    const graph::BufferId words = frame.upload("kinect2.color", color);
    auto pass = frame.compute(kPass, spirv::register_color);
    pass.read("depth_m", depth_m).read("place_x", ids.place_x).read("place_y", ids.place_y).read("Color", words);
    const graph::ImageId registered = pass.create("registered", {kInfraredExtent, vulkan::Format::kR32u});
    pass.push(gpu::RegisterColorParams{tables.host().shift_px_m, kTolerance, 0, 0});
    pass.dispatch(1, kInfraredExtent.height);
    return registered;
}

}  // namespace patina::kinect2
