#include "reconstruction/streaming/map_tiles.h"

#include <array>
#include <set>

namespace patina {

namespace {

// Of the ball's radius: half the diagonal of what one ball is enough for, and the edge of cubes where it is not.
constexpr double kOneBall = 0.75, kEdge = 0.5;

MapTile tile_at(glm::dvec3 center_m, double known_m, double block_m) {
    MapTile tile;
    tile.part.ball_m = glm::vec4(glm::vec3(center_m), static_cast<float>(known_m));
    tile.around = StreamRegion::ball(center_m, known_m + StreamRegion::kBlocksBeside * block_m);
    return tile;
}

}  // namespace

std::vector<MapTile> tiles_of_records(const std::vector<glm::ivec3>& blocks, double block_m, double known_m) {
    if (blocks.empty()) return {};
    glm::ivec3 low = blocks.front(), high = low;
    for (const glm::ivec3& block : blocks) {
        low = glm::min(low, block);
        high = glm::max(high, block);
    }
    const glm::dvec3 low_m = glm::dvec3(low) * block_m, high_m = glm::dvec3(high + 1) * block_m;
    if (glm::distance(low_m, high_m) / 2 <= kOneBall * known_m)
        return {tile_at((low_m + high_m) / 2.0, known_m, block_m)};

    // A whole number of blocks, so that each block is in one cube.
    const auto edge = std::max(static_cast<int>(kEdge * known_m / block_m), 1);
    std::set<std::array<int, 3>> cubes;
    for (const glm::ivec3& block : blocks) {
        const glm::ivec3 cube = (block - low) / edge;
        cubes.insert({cube.x, cube.y, cube.z});
    }
    std::vector<MapTile> tiles;
    for (const auto& [x, y, z] : cubes) {
        const glm::ivec3 lowest = low + glm::ivec3(x, y, z) * edge;
        const glm::dvec3 center = glm::dvec3(lowest) + edge / 2.0;
        MapTile& tile = tiles.emplace_back(tile_at(center * block_m, known_m, block_m));
        tile.part.cube_m = glm::vec4(glm::vec3(center * block_m), static_cast<float>(edge / 2.0 * block_m));
        tile.cube = StreamRegion::box(lowest, lowest + edge - 1);
    }
    return tiles;
}

}  // namespace patina
