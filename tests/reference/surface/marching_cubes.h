#pragma once

#include <array>
#include <map>
#include <vector>

#include <glm/glm.hpp>

namespace patina::reference {

/// Distances at lattice points that have been seen, by their integer coordinates (x, y, z). Inside is <= 0.
using Lattice = std::map<std::array<int, 3>, float>;

/// The points, in lattice units, where marching cubes must put a vertex: on every lattice edge with one end inside that
/// belongs to a cell whose eight corners have been seen. In the order of the edges: (lower end, axis). From the
/// definition, without a case table.
std::vector<glm::vec3> surface_vertices(const Lattice& lattice);

}  // namespace patina::reference
