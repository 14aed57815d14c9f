#include "passes/fusion/visible_blocks.h"

#include <algorithm>
#include <array>

#include "spirv/shaders.h"

namespace patina {

namespace {

/// The view grid's most cells: 128 MiB, which every device can bind.
constexpr double kMaxGridCells = 1 << 25;

/// The box of blocks around the frustum between the camera and far_m.
void set_grid(gpu::ViewParams& params) {
    const glm::dmat4 world_from_camera = glm::inverse(glm::dmat4(params.camera.camera_from_world));
    const double block_m = double(params.grid.voxel_m) * gpu::kBlockEdge;
    glm::dvec3 low(world_from_camera[3]), high(low);
    for (int corner = 0; corner < 4; ++corner) {
        const double u = corner & 1 ? params.camera.extent.x - 0.5 : -0.5;
        const double v = corner & 2 ? params.camera.extent.y - 0.5 : -0.5;
        const glm::dvec4 k(params.camera.focal_center_px);
        const glm::dvec3 ray((u - k.z) / k.x, (v - k.w) / k.y, 1);
        const glm::dvec3 point(world_from_camera * glm::dvec4(ray * double(params.far_m), 1));
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    // One block more on each side, for blocks that reach into the frustum by their margin alone.
    params.grid_low = glm::ivec4(glm::ivec3(glm::floor(low / block_m)) - 1, 0);
    params.grid_size = glm::uvec4(glm::uvec3(glm::ivec3(glm::floor(high / block_m)) + 2 - glm::ivec3(params.grid_low)), 0);
}

uint64_t cells_of(const gpu::ViewParams& params) {
    return uint64_t{params.grid_size.x} * params.grid_size.y * params.grid_size.z;
}

}  // namespace

VisibleBlocks add_visible_blocks(graph::Frame& frame, const VoxelMap& map, const VoxelMapIds& ids,
                                 const gpu::Camera& camera, float near_m, float far_m) {
    gpu::ViewParams params{};
    params.grid = map.grid();
    params.camera = camera;
    params.near_m = near_m;
    params.far_m = far_m;
    params.tiles = (camera.extent + gpu::kTileEdge - 1u) / gpu::kTileEdge;
    set_grid(params);
    while (static_cast<double>(cells_of(params)) > kMaxGridCells) {
        params.far_m *= 0.9f;
        set_grid(params);
    }

    VisibleBlocks visible;
    visible.extent = {camera.extent.x, camera.extent.y};
    visible.view = frame.upload<gpu::ViewParams>("fusion.view", std::span(&params, 1));
    visible.list = frame.fill(frame.create_buffer("fusion.visible", (1 + map.settings().capacity_blocks) * 4u), 0);
    visible.arguments = frame.fill(frame.create_buffer("fusion.visible_arguments", 16), 1);
    visible.tiles = frame.fill(
        frame.create_buffer("fusion.tiles", params.tiles.x * params.tiles.y * sizeof(gpu::TileRange)), UINT32_MAX);

    visible.grid = frame.fill(frame.create_buffer("fusion.view_grid", cells_of(params) * sizeof(uint32_t)), gpu::kNoBlock);

    auto pass = frame.compute("fusion.visible_blocks", spirv::visible_blocks);
    pass.read("BlockKeys", ids.block_keys).read("Counters", ids.counters).read("View", visible.view);
    visible.list = pass.modify("Visible", visible.list);
    visible.arguments = pass.modify("Arguments", visible.arguments);
    visible.tiles = pass.modify("Tiles", visible.tiles);
    visible.grid = pass.modify("ViewGrid", visible.grid);
    pass.dispatch_indirect(ids.block_arguments);
    return visible;
}

}  // namespace patina
