#pragma once

#include <algorithm>
#include <cmath>

#include <glm/glm.hpp>

namespace patina::reference {

/// The texel of a direction in an octahedral map of edge x edge texels: the octahedron's faces unfolded, by the faces'
/// own geometry.
inline int octahedral_texel(glm::dvec3 direction, int edge) {
    const double norm = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
    glm::dvec2 at(direction.x / norm, direction.y / norm);
    if (direction.z < 0) {
        const glm::dvec2 outside = glm::dvec2(1 - std::abs(at.y), 1 - std::abs(at.x));
        at = {at.x >= 0 ? outside.x : -outside.x, at.y >= 0 ? outside.y : -outside.y};
    }
    const auto row = [&](double v) { return std::min(static_cast<int>(std::floor((v / 2 + 0.5) * edge)), edge - 1); };
    return row(at.y) * edge + row(at.x);
}

}  // namespace patina::reference
