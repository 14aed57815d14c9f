#include "passes/texture/diffuse_picture.h"

#include "spirv/shaders.h"

namespace patina {

DiffusePicture add_diffuse_picture(graph::FrameGraph& frame, const BlendPictureInputs& inputs,
                                   const DiffusePicture& targets) {
    const Extent2D extent = frame.common_extent({inputs.color, targets.diffuse, targets.light});
    const BlendPictureInputs::Reflected& reflected = inputs.reflected.value();
    auto pass = frame.compute("texture.diffuse_picture", spirv::diffuse_picture);
    pass.read("color", inputs.color).read("depth_m", inputs.depth_m);
    pass.read("kd", reflected.kd).read("rgb", reflected.rgb).read("light", reflected.light);
    const DiffusePicture written{pass.write("diffuse", targets.diffuse), pass.write("shine", targets.light)};
    pass.push(gpu::DiffusePictureParams{glm::vec4(inputs.gain, 0), inputs.voxel_m, 0, 0, 0});
    pass.dispatch_covering(extent);
    return written;
}

}  // namespace patina
