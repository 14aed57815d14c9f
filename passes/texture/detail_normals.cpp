#include "passes/texture/detail_normals.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/packing.hpp>

#include "spirv/shaders.h"

namespace patina {

graph::BufferId add_detail_normals(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& voxels,
                                   const PlaceTexelsInputs& inputs, graph::BufferId tangents, Extent2D page) {
    auto pass = frame.compute("texture.detail_normals", spirv::detail_normals);
    pass.read("Vertices", inputs.vertices).read("Triangles", inputs.triangles);
    pass.read("Tiles", inputs.tiles).read("Lists", inputs.lists).read("Tangents", tangents);
    pass.read("Keys", voxels.keys).read("Blocks", voxels.blocks).read("Tsdf", voxels.tsdf);
    pass.specialise("kVoxelChunks", map.chunks());
    const graph::BufferId detail = pass.create("Detail", uint64_t{page.area()} * sizeof(uint32_t));
    const uint32_t tiles_x = (page.width + gpu::kTextureTile - 1) / gpu::kTextureTile;
    pass.push(gpu::DetailNormalsParams{map.grid(), {page.width, page.height}, tiles_x, 0});
    pass.dispatch_covering(page);
    return detail;
}

glm::vec3 unpack_detail(uint32_t word) {
    if (word == gpu::kNoSurface) return glm::vec3(0);
    const glm::vec2 xy = glm::unpackSnorm2x16(word);
    return {xy, std::sqrt(std::max(1 - glm::dot(xy, xy), 0.0f))};
}

}  // namespace patina
