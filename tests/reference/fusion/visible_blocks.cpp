#include "tests/reference/fusion/visible_blocks.h"

#include <algorithm>
#include <cmath>

namespace patina::reference {

std::map<std::array<int, 2>, DepthRange> seen_tiles(const ViewVolume& view, int tile_px, glm::dvec3 low_m,
                                                    double edge_m) {
    std::map<std::array<int, 2>, DepthRange> tiles;
    const RigidTransform camera_from_world = rigid_inverse(view.world_from_camera);
    for (int i = 0; i < 9 * 9 * 9; ++i) {
        const glm::dvec3 offset = glm::dvec3(i % 9, i / 9 % 9, i / 81) / 8.0 * edge_m;
        const glm::dvec3 point(camera_from_world * glm::dvec4(low_m + offset, 1));
        if (point.z < view.near_m || point.z > view.far_m) continue;
        const glm::dvec2 px = project(view.camera, point), pixel = glm::floor(px + 0.5);
        if (!view.camera.extent.contains(static_cast<int>(pixel.x), static_cast<int>(pixel.y))) continue;
        // Rays run through the pixels' centres: what lies between the last of one tile and the first of the next is
        // on no ray, and counts as the former's.
        const glm::ivec2 before(glm::max(px, 0.0));
        const std::array<int, 2> tile{before.x / tile_px, before.y / tile_px};
        DepthRange& range = tiles.try_emplace(tile, DepthRange{point.z, point.z}).first->second;
        range = {std::min(range.near_m, point.z), std::max(range.far_m, point.z)};
    }
    return tiles;
}

bool outside_view(const ViewVolume& view, glm::dvec3 center_m, double radius_m) {
    const glm::dvec3 center(rigid_inverse(view.world_from_camera) * glm::dvec4(center_m, 1));
    if (center.z + radius_m < view.near_m || center.z - radius_m > view.far_m) return true;
    const Intrinsics& c = view.camera;
    const glm::dvec3 normals[] = {{c.fx, 0, c.cx + 0.5},
                                  {-c.fx, 0, c.extent.width - 0.5 - c.cx},
                                  {0, c.fy, c.cy + 0.5},
                                  {0, -c.fy, c.extent.height - 0.5 - c.cy}};
    return std::any_of(std::begin(normals), std::end(normals),
                       [&](glm::dvec3 n) { return glm::dot(glm::normalize(n), center) < -radius_m; });
}

}  // namespace patina::reference
