#include "passes/texture/albedo_picture.h"

#include "spirv/shaders.h"

namespace patina {

graph::ImageId add_albedo_picture(graph::FrameGraph& frame, const BlendPictureInputs& inputs, graph::ImageId albedo) {
    const Extent2D extent = frame.common_extent({inputs.color, albedo});
    const BlendPictureInputs::Reflected& reflected = inputs.reflected.value();
    auto pass = frame.compute("texture.albedo_picture", spirv::albedo_picture);
    pass.read("color", inputs.color).read("depth_m", inputs.depth_m);
    pass.read("kd", reflected.kd).read("rgb", reflected.rgb).read("light", reflected.light);
    const graph::ImageId written = pass.write("albedo", albedo);
    pass.push(gpu::AlbedoPictureParams{glm::vec4(inputs.gain, 0), inputs.voxel_m, 0, 0, 0});
    pass.dispatch_covering(extent);
    return written;
}

}  // namespace patina
