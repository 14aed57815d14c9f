#include "tests/reference/shading/reflect_surroundings.h"

#include <cmath>
#include <numbers>

#include "tests/reference/shading/ward.h"

namespace patina::reference {

glm::dvec3 mirrored(const std::function<glm::dvec3(glm::dvec3)>& arrives, glm::dvec3 normal, glm::dvec3 to_viewer,
                    double alpha, int steps) {
    const glm::dvec3 pole = glm::reflect(-to_viewer, normal);
    const glm::dvec3 side =
        glm::normalize(glm::cross(pole, std::abs(pole.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dvec3 up = glm::cross(pole, side);
    const Ward gloss{glm::dvec3(0), glm::dvec3(1), alpha};
    glm::dvec3 sum(0);
    for (int i = 0; i < steps; ++i) {
        // angle = pi t^2
        const double t = (i + 0.5) / steps, angle = std::numbers::pi * t * t;
        const double area = 2 * std::numbers::pi * t / steps * std::sin(angle) * 2 * std::numbers::pi / (4 * steps);
        for (int j = 0; j < 4 * steps; ++j) {
            const double around = 2 * std::numbers::pi * (j + 0.5) / (4 * steps);
            const glm::dvec3 to_light =
                std::cos(angle) * pole + std::sin(angle) * (std::cos(around) * side + std::sin(around) * up);
            const double cosine = glm::dot(normal, to_light);
            if (cosine > 0) sum += ward(gloss, normal, to_light, to_viewer) * cosine * area * arrives(to_light);
        }
    }
    return sum;
}

}  // namespace patina::reference
