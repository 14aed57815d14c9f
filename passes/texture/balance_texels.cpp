#include "passes/texture/balance_texels.h"

#include <algorithm>
#include <cmath>

#include "spirv/shaders.h"

namespace patina {

namespace {
constexpr float kMostFactor = 4.0f;
}

glm::uvec2 blocks_of(Extent2D page) {
    return (glm::uvec2(page.width, page.height) + gpu::kTextureBlock - 1u) / gpu::kTextureBlock;
}

graph::BufferId add_average_texels(graph::FrameGraph& frame, const TextureBand& band, const TextureBandIds& ids,
                                   graph::BufferId blocks, Extent2D page) {
    auto pass = frame.compute("texture.average_texels", spirv::average_texels);
    pass.read("Texels", ids.texels).read("Sums", ids.sums).read("Known", ids.known);
    const graph::BufferId averaged = pass.modify("Blocks", blocks);
    const Extent2D extent = band.extent();
    pass.push(gpu::AverageTexelsParams{{extent.width, extent.height}, band.first_row(), blocks_of(page).x});
    const glm::uvec2 own = blocks_of(extent);
    pass.dispatch_covering(Extent2D{own.x, own.y});
    return averaged;
}

TextureBalance add_balance_blocks(graph::FrameGraph& frame, graph::BufferId blocks, Extent2D page, double texel_m,
                                  bool known) {
    const glm::uvec2 count = blocks_of(page);
    const double block_m = texel_m * gpu::kTextureBlock;
    const auto stride = static_cast<uint32_t>(std::max(std::lround(kBalanceReach_m / gpu::kBalanceTaps / block_m), 1L));
    auto pass = frame.compute("texture.balance_blocks", spirv::balance_blocks);
    pass.read("Blocks", blocks);
    const graph::BufferId balance = pass.create("Balance", uint64_t{count.x} * count.y * sizeof(glm::vec4));
    pass.push(gpu::BalanceBlocksParams{count, stride, static_cast<float>(kBalanceReach_m), known ? kMostFactor : 1.0f,
                                       0, 0, 0});
    pass.dispatch_covering(Extent2D{count.x, count.y});
    return {blocks, balance};
}

}  // namespace patina
