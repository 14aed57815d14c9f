#pragma once

#include <glm/glm.hpp>

namespace patina {

/// The block that holds a point, given in units of a block's edge. Farther than 2^27 blocks from the origin, where
/// coordinates of voxels would leave 32 bits, the nearest one within.
inline glm::ivec3 block_at(glm::dvec3 point) {
    constexpr double kFarthestBlock = 1 << 27;
    return glm::ivec3(glm::clamp(glm::floor(point), -kFarthestBlock, kFarthestBlock));
}

}  // namespace patina
