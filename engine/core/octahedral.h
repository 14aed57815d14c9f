#pragma once

#include <glm/glm.hpp>

namespace patina {

/// The octahedral map of directions (Cigolle et al. 2014, "A survey of efficient representations for independent unit
/// vectors"), as lib/math/octahedral.glsl has it: +z is in the middle, -z in the corners.

/// The unit direction of a point; x and y from -1 to 1.
glm::dvec3 direction_of_octahedral(glm::dvec2 point);

/// The point of a direction, of any length but 0.
glm::dvec2 octahedral_of_direction(glm::dvec3 direction);

}  // namespace patina
