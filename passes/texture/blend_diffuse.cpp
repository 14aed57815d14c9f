#include "passes/texture/blend_diffuse.h"

#include "spirv/shaders.h"

namespace patina {

ViewTexelIds add_blend_diffuse(graph::FrameGraph& frame, const TextureBand& page, const ViewTexelIds& ids,
                               const BlendDiffuseInputs& inputs) {
    auto pass = frame.compute("texture.blend_diffuse", spirv::blend_diffuse);
    pass.read("Texels", ids.texels.texels);
    ViewTexelIds blended = ids;
    blended.texels.sums = pass.modify("Sums", ids.texels.sums);
    blended.shown = pass.modify("Shown", ids.shown);
    pass.read("diffuse", inputs.picture.diffuse).read("light", inputs.picture.light).read("depth_m", inputs.depth_m);
    const glm::vec3 eye_m = inputs.eye_m;
    pass.push(
        gpu::BlendDiffuseParams{inputs.camera, eye_m.x, eye_m.y, eye_m.z, inputs.voxel_m, page.texels(), 0, 0, 0});
    pass.dispatch_covering(page.texels());
    return blended;
}

}  // namespace patina
