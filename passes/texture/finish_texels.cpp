#include "passes/texture/finish_texels.h"

#include "spirv/shaders.h"

namespace patina {

graph::BufferId add_finish_texels(graph::FrameGraph& frame, const TextureBand& band, const TextureBandIds& ids,
                                  const TextureBalance& balance, Extent2D page) {
    auto pass = frame.compute("texture.finish_texels", spirv::finish_texels);
    pass.read("Texels", ids.texels).read("Sums", ids.sums).read("Known", ids.known);
    pass.read("Blocks", balance.blocks).read("Balance", balance.balance);
    const graph::BufferId albedo = pass.create("Albedo", uint64_t{band.texels()} * sizeof(uint32_t));
    const Extent2D extent = band.extent();
    const glm::uvec2 blocks = blocks_of(page);
    pass.push(gpu::FinishTexelsParams{{extent.width, extent.height},
                                      band.first_row(),
                                      blocks.x,
                                      blocks.y,
                                      static_cast<float>(kBalanceReach_m),
                                      0,
                                      0});
    pass.dispatch_covering(extent);
    return albedo;
}

glm::vec3 unpack_albedo(uint32_t word) {
    const glm::vec3 root(word & 1023u, word >> 10 & 1023u, word >> 20 & 1023u);
    return root * root / (1023.0f * 1023.0f);
}

}  // namespace patina
