#pragma once

#include <glm/glm.hpp>

#include "tests/reference/fusion/volume.h"

namespace patina::reference {

/// A volume's linear colour at a world point (metres): the mean over the voxel centres around it that have a colour,
/// weighted by their share in trilinear interpolation. a = 1, or all zero where none has one.
glm::dvec4 color_at(const Volume& volume, glm::dvec3 point_m);

}  // namespace patina::reference
