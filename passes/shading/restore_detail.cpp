#include "passes/shading/restore_detail.h"

#include "shared/shading/restore_detail.h"
#include "spirv/shaders.h"

namespace patina {

PredictedImages add_restore_detail(graph::FrameGraph& frame, const PredictedImages& predicted,
                                   const RestoreDetailInputs& inputs) {
    const Extent2D extent = frame.common_extent(
        {inputs.position_m, inputs.normal, inputs.color, predicted.kd, predicted.picture_kd, predicted.rgb});
    auto pack = frame.compute("shading.pack_detail", spirv::pack_detail);
    pack.read("color", inputs.color)
        .read("light", predicted.light)
        .read("kd", predicted.kd)
        .read("picture_kd", predicted.picture_kd);
    const graph::ImageId detail = pack.create("detail", {extent, vulkan::Format::kRgba32u});
    pack.dispatch_covering(extent);

    auto pass = frame.compute("shading.restore_detail", spirv::restore_detail);
    pass.read("position_m", inputs.position_m).read("normal", inputs.normal).read("detail", detail);
    pass.read("light", predicted.light).read("rgb", predicted.rgb).read("ks_alpha", predicted.ks_alpha);
    PredictedImages detailed = predicted;
    detailed.kd = pass.create("detailed_kd", {extent, vulkan::Format::kRgba16f});
    detailed.rgb = pass.create("detailed_rgb", {extent, vulkan::Format::kRgba16f});
    pass.push(gpu::RestoreDetailParams{inputs.focal_px, inputs.voxel_m});
    pass.dispatch_covering(extent);
    return detailed;
}

}  // namespace patina
