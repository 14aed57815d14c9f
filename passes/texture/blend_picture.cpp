#include "passes/texture/blend_picture.h"

#include <array>
#include <span>

#include "spirv/shaders.h"

namespace patina {

namespace {

constexpr std::array<uint64_t, 1> kBlack{};

/// Without reflectance the shader reads none of the three.
BlendPictureInputs::Reflected nothing(graph::FrameGraph& frame) {
    const auto pixel = [&](const char* name) {
        return frame.upload(name, {Extent2D{1, 1}, vulkan::Format::kRgba16f},
                            std::as_bytes(std::span<const uint64_t, 1>(kBlack)));
    };
    return {pixel("no kd"), pixel("no rgb"), pixel("no light")};
}

ViewTexelIds blend(graph::FrameGraph& frame, const TextureBand& band, const ViewTexelIds& ids,
                   const BlendPictureInputs& inputs, std::optional<glm::vec3> eye_m) {
    auto pass = frame.compute("texture.blend_picture", spirv::blend_picture);
    pass.specialise("kReflects", inputs.reflected ? 1u : 0u).specialise("kForEye", eye_m ? 1u : 0u);
    pass.read("Texels", ids.texels.texels);
    ViewTexelIds blended = ids;
    blended.texels.sums = pass.modify("Sums", ids.texels.sums);
    blended.shown = pass.modify("Shown", ids.shown);
    pass.read("color", inputs.color).read("depth_m", inputs.depth_m);
    const BlendPictureInputs::Reflected reflected = inputs.reflected ? *inputs.reflected : nothing(frame);
    pass.read("kd", reflected.kd).read("rgb", reflected.rgb).read("light", reflected.light);
    const glm::vec3 eye = eye_m.value_or(glm::vec3(0));
    pass.push(gpu::BlendPictureParams{inputs.camera, glm::vec4(inputs.gain, inputs.voxel_m), eye.x, eye.y, eye.z,
                                      band.texels()});
    pass.dispatch_covering(band.texels());
    return blended;
}

}  // namespace

TextureBandIds add_blend_picture(graph::FrameGraph& frame, const TextureBand& band, const TextureBandIds& ids,
                                 const BlendPictureInputs& inputs) {
    const graph::BufferId unused = frame.fill(frame.create_buffer("unused", sizeof(glm::vec4)), 0);
    return blend(frame, band, {ids, unused}, inputs, std::nullopt).texels;
}

ViewTexelIds add_blend_picture_for(graph::FrameGraph& frame, const TextureBand& band, const ViewTexelIds& ids,
                                   const BlendPictureInputs& inputs, glm::vec3 eye_m) {
    return blend(frame, band, ids, inputs, eye_m);
}

}  // namespace patina
