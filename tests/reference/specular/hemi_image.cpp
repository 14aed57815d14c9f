#include "tests/reference/specular/hemi_image.h"

#include <cmath>

namespace patina::reference {

namespace {

/// On the disk, in [-1, 1]^2.
glm::dvec2 on_disk(glm::dvec3 normal, glm::dvec3 direction, bool orthogonal) {
    const glm::dvec3 world = std::abs(normal.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
    const glm::dvec3 y = glm::normalize(glm::cross(normal, world)), x = glm::cross(y, normal);
    const glm::dvec2 across(glm::dot(direction, x), glm::dot(direction, y));
    const double up = glm::dot(direction, normal);
    if (up <= 0) return glm::normalize(across);
    return orthogonal ? across : across / (1 + up);
}

}  // namespace

HemiImage hemi_image(glm::dvec3 normal, const std::vector<glm::dvec3>& directions, bool orthogonal, size_t side) {
    const double half = static_cast<double>(side - 1) / 2;
    HemiImage image;
    for (size_t pixel = 0; pixel < side * side; ++pixel) {
        const glm::dvec2 center(pixel % side, pixel / side);
        size_t nearest = 0;
        double least = 1e9, next = 1e9;
        for (size_t k = 0; k < directions.size(); ++k) {
            const glm::dvec2 place = half + half * on_disk(normal, directions[k], orthogonal);
            const double distance = glm::distance(place, center);
            if (distance < least) {
                next = least;
                least = distance;
                nearest = k;
            } else {
                next = std::min(next, distance);
            }
        }
        image.nearest.push_back(nearest);
        image.margin.push_back(next - least);
    }
    return image;
}

}  // namespace patina::reference
