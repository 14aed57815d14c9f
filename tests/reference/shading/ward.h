#pragma once

#include <glm/glm.hpp>

namespace patina::reference {

/// The parameters of the Ward BRDF (paper, Eq. 2-4).
struct Ward {
    glm::dvec3 kd{0};
    glm::dvec3 ks{0};
    double alpha = 1;
};

/// The Ward BRDF in 1/sr, from the angles as the paper writes it. All directions have unit length. 0 where the light or
/// the viewer is not above the horizon.
glm::dvec3 ward(const Ward& material, glm::dvec3 normal, glm::dvec3 to_light, glm::dvec3 to_viewer);

}  // namespace patina::reference
