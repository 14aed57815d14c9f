#pragma once

#include <glm/glm.hpp>

#include "tests/reference/fusion/volume.h"

namespace patina::reference {

/// The least distance (metres) of a volume's surface along the way from `from_m` to `to_m`, in small steps; below zero
/// where the way leads through the inside. Large where nothing near was seen.
double least_distance_m(const Volume& volume, glm::dvec3 from_m, glm::dvec3 to_m);

}  // namespace patina::reference
