#include "passes/fusion/visible_blocks.h"

#include "spirv/shaders.h"

namespace patina {

VisibleBlocks add_visible_blocks(graph::Frame& frame, const VoxelMap& map, const VoxelMapIds& ids,
                                 const gpu::Camera& camera, float near_m, float far_m) {
    gpu::ViewParams params{};
    params.grid = map.grid();
    params.camera = camera;
    params.near_m = near_m;
    params.far_m = far_m;
    params.tiles = (camera.extent + gpu::kTileEdge - 1u) / gpu::kTileEdge;

    VisibleBlocks visible;
    visible.extent = {camera.extent.x, camera.extent.y};
    visible.view = frame.upload<gpu::ViewParams>("fusion.view", std::span(&params, 1));
    visible.list = frame.fill(frame.create_buffer("fusion.visible", (1 + map.settings().capacity_blocks) * 4u), 0);
    visible.arguments = frame.fill(frame.create_buffer("fusion.visible_arguments", 16), 1);
    visible.tiles = frame.fill(
        frame.create_buffer("fusion.tiles", params.tiles.x * params.tiles.y * sizeof(gpu::TileRange)), UINT32_MAX);

    auto pass = frame.compute("fusion.visible_blocks", spirv::visible_blocks);
    pass.read("BlockKeys", ids.block_keys).read("Counters", ids.counters).read("View", visible.view);
    visible.list = pass.modify("Visible", visible.list);
    visible.arguments = pass.modify("Arguments", visible.arguments);
    visible.tiles = pass.modify("Tiles", visible.tiles);
    pass.dispatch_indirect(ids.block_arguments);
    return visible;
}

}  // namespace patina
