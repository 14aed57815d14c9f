#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

namespace patina::reference {

/// Coordinates of a block of 8^3 voxels: block b spans [b, b + 1) times the block's edge from the world's origin.
using BlockCoordinates = std::array<int, 3>;

struct Voxel {
    double sdf_m = 0;
    double weight = 0;  ///< 0: never seen
    glm::dvec3 color{0};
    bool colored = false;
};

/// A sparse volume in plain memory: blocks of 512 voxels, x fastest, then y, then z.
struct Volume {
    double voxel_m = 0;
    std::map<BlockCoordinates, std::vector<Voxel>> blocks;

    /// Null where there is no block.
    const Voxel* find(glm::ivec3 voxel) const;

    /// Centre of voxel `index` of a block (metres).
    glm::dvec3 center_m(const BlockCoordinates& block, int index) const;

    /// The distance at a world point (metres), interpolated between the eight voxel centres around it; nothing where
    /// one of these has not been seen.
    std::optional<double> distance_at(glm::dvec3 point_m) const;
};

}  // namespace patina::reference
