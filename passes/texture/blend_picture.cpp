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

}  // namespace

TextureBandIds add_blend_picture(graph::FrameGraph& frame, const TextureBand& band, const TextureBandIds& ids,
                                 const BlendPictureInputs& inputs) {
    auto pass = frame.compute("texture.blend_picture", spirv::blend_picture);
    pass.specialise("kReflects", inputs.reflected ? 1u : 0u).read("Texels", ids.texels);
    TextureBandIds blended = ids;
    blended.sums = pass.modify("Sums", ids.sums);
    pass.read("color", inputs.color).read("depth_m", inputs.depth_m);
    const BlendPictureInputs::Reflected reflected = inputs.reflected ? *inputs.reflected : nothing(frame);
    pass.read("kd", reflected.kd).read("rgb", reflected.rgb).read("light", reflected.light);
    pass.push(gpu::BlendPictureParams{inputs.camera, glm::vec4(inputs.gain, inputs.voxel_m), band.texels(), 0, 0, 0});
    pass.dispatch_covering(band.texels());
    return blended;
}

}  // namespace patina
