#pragma once

#include <functional>

#include <glm/glm.hpp>

namespace patina::reference {

/// The radiance that a Ward lobe of ks 1 sends to the viewer (paper, Eq. 3, 4 and 6), where `arrives` says what comes
/// from a direction: the integral over the hemisphere, by `steps` x 4 steps directions around the mirrored one, the
/// farther from it the farther apart.
glm::dvec3 mirrored(const std::function<glm::dvec3(glm::dvec3)>& arrives, glm::dvec3 normal, glm::dvec3 to_viewer,
                    double alpha, int steps);

}  // namespace patina::reference
