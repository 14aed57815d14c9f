#pragma once

#include <glm/glm.hpp>

#include "sensor/synthetic/shape.h"

namespace patina::figure {

/// The signed distance to the figure of the scene `bunnies`: a sitting hare with a scarf, one ear bent. About 1.5 units
/// high, y upwards from the floor at 0, looking along +z.
double hare(glm::dvec3 p);

/// Its surface as shipped.
sensor::TriangleMesh make_hare();

}  // namespace patina::figure
