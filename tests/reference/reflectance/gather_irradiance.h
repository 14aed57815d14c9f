#pragma once

#include <glm/glm.hpp>

#include "tests/reference/fusion/volume.h"

namespace patina::reference {

/// What arrives at a surface point from a volume's surfaces around it.
struct GatheredIrradiance {
    glm::dvec3 mean{0};  ///< radiance where a ray meets a surface, over cosine-weighted directions
    double missed = 0;   ///< share of the rays that meet none
};

/// By `rings` x 2 rings rays, marched in small steps; each takes the colour of the voxel where it first meets a
/// surface. Rays begin `lift_m` above the surface.
GatheredIrradiance gather_irradiance(const Volume& volume, glm::dvec3 point_m, glm::dvec3 normal, double lift_m,
                                     double reach_m, int rings);

}  // namespace patina::reference
