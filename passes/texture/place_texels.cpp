#include "passes/texture/place_texels.h"

#include "spirv/shaders.h"

namespace patina {

TextureBandIds add_place_texels(graph::FrameGraph& frame, const TextureBand& band, const PlaceTexelsInputs& inputs) {
    TextureBandIds ids = band.import(frame);
    ids.sums = frame.fill(ids.sums, 0);
    auto pass = frame.compute("texture.place_texels", spirv::place_texels);
    pass.read("Vertices", inputs.vertices).read("Triangles", inputs.triangles);
    pass.read("Tiles", inputs.tiles).read("Lists", inputs.lists);
    ids.texels = pass.write("Texels", ids.texels);
    ids.known = pass.write("Known", ids.known);
    const Extent2D extent = band.extent();
    const uint32_t tiles_x = (extent.width + gpu::kTextureTile - 1) / gpu::kTextureTile;
    pass.push(gpu::PlaceTexelsParams{{extent.width, extent.height}, band.first_row(), tiles_x});
    pass.dispatch_covering(extent);
    return ids;
}

}  // namespace patina
