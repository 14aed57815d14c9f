#pragma once

#include <glm/glm.hpp>

#include "scenes/description/shape.h"

namespace patina::figure {

/// The signed distance to the figure of the scene `bunnies`: a sitting hare with a scarf, one ear bent. About 1.5 units
/// high, y upwards from the floor at 0, looking along +z.
double hare(glm::dvec3 p);

/// Its surface as shipped.
scenes::TriangleMesh make_hare();

}  // namespace patina::figure
