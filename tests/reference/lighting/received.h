#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace patina::reference {

/// Where light is received.
struct Receiver {
    glm::vec3 point_m, normal;
};

/// What a lamp of intensity 1 gives a place that nothing shades: irradiance over pi.
float received(const Receiver& receiver, glm::vec3 lamp_m);
std::vector<float> received(std::span<const Receiver> receivers, glm::vec3 lamp_m);

}  // namespace patina::reference
