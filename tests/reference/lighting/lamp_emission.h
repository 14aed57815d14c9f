#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/glm.hpp>

namespace patina::reference {

/// What a lamp sends to where it is seen in a direction: the angle to its axis, if it has one, tells how much.
inline glm::dvec3 emitted(glm::dvec3 intensity, glm::dvec3 axis, glm::dvec3 to_lamp) {
    if (glm::length(axis) == 0) return intensity;
    const double angle = std::acos(std::clamp(glm::dot(axis, to_lamp) / glm::length(to_lamp), -1.0, 1.0));
    return angle > std::numbers::pi / 2 ? -std::cos(angle) * intensity : glm::dvec3(0);
}

}  // namespace patina::reference
