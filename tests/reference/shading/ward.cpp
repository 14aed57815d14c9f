#include "tests/reference/shading/ward.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace patina::reference {

glm::dvec3 ward(const Ward& material, glm::dvec3 normal, glm::dvec3 to_light, glm::dvec3 to_viewer) {
    const auto angle_to_normal = [&](glm::dvec3 d) { return std::acos(std::clamp(glm::dot(normal, d), -1.0, 1.0)); };
    const double theta_i = angle_to_normal(to_light);
    const double theta_o = angle_to_normal(to_viewer);
    if (std::max(theta_i, theta_o) >= std::numbers::pi / 2) return glm::dvec3(0);
    const double theta_h = angle_to_normal(glm::normalize(to_light + to_viewer));
    const double gamma = -std::pow(std::tan(theta_h) / material.alpha, 2);
    const double n =
        4 * std::numbers::pi * std::pow(material.alpha, 2) * std::sqrt(std::cos(theta_i) * std::cos(theta_o));
    return material.kd / std::numbers::pi + material.ks / n * std::exp(gamma);
}

}  // namespace patina::reference
