#include "passes/fusion/visible_blocks.h"

#include <algorithm>
#include <array>
#include <limits>

#include "passes/state/block_at.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

/// The view grid's most cells along an edge: 128 MiB in all, which every device can bind.
constexpr uint64_t kMaxGridEdge = 322;
/// Beside those of the frustum: for blocks that reach into it by their margin alone, and for rounding.
constexpr uint64_t kGridMargin = 4;

/// The camera's centre and where the corners of its image lie at far_m, in camera coordinates (metres).
std::array<glm::dvec3, 5> frustum_points(const gpu::ViewParams& params) {
    const glm::dvec4 k(params.camera.focal_center_px);
    std::array<glm::dvec3, 5> points{};
    for (int corner = 0; corner < 4; ++corner) {
        const double u = corner & 1 ? params.camera.extent.x - 0.5 : -0.5;
        const double v = corner & 2 ? params.camera.extent.y - 0.5 : -0.5;
        points[corner] = glm::dvec3((u - k.z) / k.x, (v - k.w) / k.y, 1) * double(params.far_m);
    }
    return points;
}

double block_edge_m(const gpu::ViewParams& params) { return double(params.grid.voxel_m) * gpu::kBlockEdge; }

/// How far apart any two points of the frustum are at most.
double widest_m(const gpu::ViewParams& params) {
    double widest_m = 0;
    const auto points = frustum_points(params);
    for (const glm::dvec3& a : points) {
        for (const glm::dvec3& b : points) widest_m = std::max(widest_m, glm::length(a - b));
    }
    return widest_m;
}

/// Cells enough for the frustum however the camera is turned, so that frames keep their shape: a cube as wide as its
/// two points farthest apart.
uint64_t cells_for_any_pose(const gpu::ViewParams& params) {
    const auto edge = static_cast<uint64_t>(widest_m(params) / block_edge_m(params)) + kGridMargin;
    return edge * edge * edge;
}

/// The box of blocks around the frustum. Where block_at() has to clamp, the map has no blocks.
void place_grid(gpu::ViewParams& params) {
    const glm::dmat4 world_from_camera = glm::inverse(glm::dmat4(params.camera.camera_from_world));
    glm::dvec3 low(std::numeric_limits<double>::max()), high(-low);
    for (const glm::dvec3& point : frustum_points(params)) {
        const glm::dvec3 world(world_from_camera * glm::dvec4(point, 1));
        low = glm::min(low, world);
        high = glm::max(high, world);
    }
    const double block_m = block_edge_m(params);
    const glm::ivec3 first = block_at(low / block_m) - 1;
    const glm::ivec3 last = block_at(high / block_m) + 1;
    params.grid_low = glm::ivec4(first, 0);
    params.grid_size = glm::uvec4(glm::uvec3(last - first + 1), 0);
}

}  // namespace

double frustum_radius_m(const gpu::Camera& camera, float far_m) {
    gpu::ViewParams params{};
    params.camera = camera;
    params.far_m = far_m;
    double radius_m = 0;
    for (const glm::dvec3& point : frustum_points(params)) radius_m = std::max(radius_m, glm::length(point));
    return radius_m;
}

float view_reach_m(const gpu::Camera& camera, float voxel_m, float far_m) {
    gpu::ViewParams params{};
    params.grid.voxel_m = voxel_m;
    params.camera = camera;
    params.far_m = 1;
    const double most_m = (kMaxGridEdge - kGridMargin) * block_edge_m(params) / widest_m(params);
    return std::min(far_m, static_cast<float>(most_m));
}

VisibleBlocks add_visible_blocks(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& ids,
                                 const gpu::Camera& camera, float near_m, float far_m) {
    gpu::ViewParams params{};
    params.grid = map.grid();
    params.camera = camera;
    params.near_m = near_m;
    params.far_m = view_reach_m(camera, params.grid.voxel_m, far_m);
    params.tiles = (camera.extent + gpu::kTileEdge - 1u) / gpu::kTileEdge;
    place_grid(params);

    VisibleBlocks visible;
    visible.extent = {camera.extent.x, camera.extent.y};
    visible.view = frame.upload<gpu::ViewParams>("fusion.view", std::span(&params, 1));
    visible.list = frame.fill(frame.create_buffer("fusion.visible", (1 + map.capacity()) * 4u), 0);
    visible.arguments = frame.fill(frame.create_buffer("fusion.visible_arguments", 16), 1);
    visible.tiles = frame.fill(
        frame.create_buffer("fusion.tiles", params.tiles.x * params.tiles.y * sizeof(gpu::TileRange)), UINT32_MAX);

    const uint64_t cells = uint64_t{params.grid_size.x} * params.grid_size.y * params.grid_size.z;
    visible.grid = frame.fill(frame.create_buffer("fusion.view_grid", cells_for_any_pose(params) * sizeof(uint32_t)),
                              gpu::kNoBlock, cells * sizeof(uint32_t));

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
