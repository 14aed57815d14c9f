#include "engine/core/octahedral.h"

#include <algorithm>
#include <cmath>

namespace patina {

glm::dvec3 direction_of_octahedral(glm::dvec2 point) {
    const double z = 1 - std::abs(point.x) - std::abs(point.y), folded = std::max(-z, 0.0);
    return glm::normalize(
        glm::dvec3(point.x - std::copysign(folded, point.x), point.y - std::copysign(folded, point.y), z));
}

glm::dvec2 octahedral_of_direction(glm::dvec3 direction) {
    const glm::dvec3 size = glm::abs(direction);
    const glm::dvec2 point = glm::dvec2(direction) / (size.x + size.y + size.z);
    if (direction.z >= 0) return point;
    return {std::copysign(1 - std::abs(point.y), point.x), std::copysign(1 - std::abs(point.x), point.y)};
}

}  // namespace patina
