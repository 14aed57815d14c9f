#pragma once

#include <vector>

#include <glm/glm.hpp>

namespace patina::reference {

/// The HemiImage of one surface point.
struct HemiImage {
    std::vector<size_t> nearest;  ///< observation by pixel, row by row
    std::vector<double> margin;   ///< pixels by which the next one is farther; large where there is none
};

/// Directions over the surface on a disk that fills `side` x `side` pixels: parabolic, or orthogonal.
HemiImage hemi_image(glm::dvec3 normal, const std::vector<glm::dvec3>& directions, bool orthogonal, size_t side);

}  // namespace patina::reference
