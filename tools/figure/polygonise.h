#pragma once

#include <functional>

#include <glm/glm.hpp>

#include "scenes/description/shape.h"

namespace patina::figure {

/// A solid: negative inside, continuous.
using Distance = std::function<double(glm::dvec3)>;

/// Triangles on the surface of a solid that lies between `low` and `high`: marching cubes on a grid of `cell`, then the
/// vertices are spread evenly and pulled onto the surface. Counter-clockwise seen from outside; normals are the
/// distance's gradient. Closed when the solid touches neither bound. The same arguments give the same mesh.
scenes::TriangleMesh polygonise(const Distance& distance, glm::dvec3 low, glm::dvec3 high, double cell);

/// The direction in which the distance grows, by central differences.
glm::dvec3 surface_normal(const Distance& distance, glm::dvec3 p);

}  // namespace patina::figure
