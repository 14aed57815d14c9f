#include "passes/texture/show_texels.h"

#include "passes/texture/balance_texels.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

struct Blocks {
    glm::uvec2 count;
    TextureBalance balance;
};

Blocks add_blocks(graph::FrameGraph& frame, const TextureBand& page, const TextureBandIds& texels, double pixel_m) {
    const glm::uvec2 count = blocks_of(page.extent());
    const graph::BufferId empty =
        frame.create_buffer("view blocks", uint64_t{count.x} * count.y * sizeof(gpu::TextureBlock));
    const graph::BufferId blocks = add_average_texels(frame, page, texels, frame.fill(empty, 0), page.extent());
    return {count, add_balance_blocks(frame, blocks, page.extent(), pixel_m, true)};
}

/// rgba16f. Balanced: the albedo, as in `elsewhere` where no picture tells it. Else what `texels` hold; a: 1 there.
graph::ImageId add_view_texels(graph::FrameGraph& frame, const TextureBand& page, const TextureBandIds& texels,
                               const Blocks& blocks, graph::ImageId elsewhere, bool balanced) {
    auto pass = frame.compute("texture.view_texels", spirv::view_texels);
    pass.specialise("kBalanced", balanced ? 1u : 0u);
    pass.read("Texels", texels.texels).read("Sums", texels.sums);
    pass.read("Blocks", blocks.balance.blocks).read("Balance", blocks.balance.balance);
    pass.read("elsewhere", elsewhere);
    const graph::ImageId pixels = pass.create("pixels", {page.extent(), vulkan::Format::kRgba16f});
    pass.push(gpu::ViewTexelsParams{blocks.count, static_cast<float>(kBalanceReach_m), 0});
    pass.dispatch_covering(page.extent());
    return pixels;
}

}  // namespace

ViewTexelIds add_place_view(graph::FrameGraph& frame, const TextureBand& page, graph::ImageId position_m,
                            graph::ImageId normal, graph::ImageId kd) {
    const Extent2D extent = frame.common_extent({position_m, normal, kd});
    TextureBandIds texels = page.import(frame);
    texels.sums = frame.fill(texels.sums, 0);
    auto pass = frame.compute("texture.place_view", spirv::place_view);
    pass.read("position_m", position_m).read("normal", normal).read("kd", kd);
    texels.texels = pass.write("Texels", texels.texels);
    texels.known = pass.write("Known", texels.known);
    pass.dispatch_covering(extent);
    const graph::BufferId shown = frame.create_buffer("shown by pictures", extent.area() * sizeof(glm::vec4));
    return {texels, frame.fill(shown, 0)};
}

ShownTexels add_show_texels(graph::FrameGraph& frame, const TextureBand& page, const ViewTexelIds& view,
                            const ShowTexelsInputs& inputs) {
    const Blocks blocks = add_blocks(frame, page, view.texels, inputs.pixel_m);
    ShownTexels shown;
    shown.kd = add_view_texels(frame, page, view.texels, blocks, inputs.kd_elsewhere, true);
    TextureBandIds all = view.texels;
    all.sums = view.shown;
    const graph::ImageId seen =
        inputs.other_light ? shown.kd : add_view_texels(frame, page, all, blocks, inputs.kd_elsewhere, false);
    auto pass = frame.compute("texture.show_texels", spirv::show_texels);
    pass.specialise("kPictured", inputs.other_light ? 0u : 1u);
    // Under other light each known albedo is shown in it: there is no elsewhere.
    pass.read("seen", seen).read("elsewhere", inputs.other_light ? inputs.kd : inputs.rgb_elsewhere);
    pass.read("rgb", inputs.rgb).read("picture_kd", inputs.picture_kd).read("light", inputs.light);
    shown.rgb = pass.create("shown_rgb", {page.extent(), vulkan::Format::kRgba16f});
    pass.dispatch_covering(page.extent());
    return shown;
}

}  // namespace patina
