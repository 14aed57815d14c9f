#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "patina/lighting.h"

namespace patina::reference {

/// A stretch of surface, as a record knows it.
struct KnownSurface {
    glm::dvec3 point_m{0}, normal{0};
    glm::dvec3 kd{0}, certainty{0};  ///< by channel, 0 to 1
    glm::dvec3 kd_around{0};         ///< of the surface around that looks the same; 0: not known
    std::vector<bool> lit;           ///< by lamp: it reaches the surface
    glm::dvec3 around{0};            ///< what arrives from all around, irradiance over pi
};

/// The radiance that it sends to all sides under lamps and what arrives from around, without gloss; 0 where no kd is
/// known.
glm::dvec3 sent_by(const KnownSurface& surface, const std::vector<Light>& lamps);

}  // namespace patina::reference
