#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace patina::reference {

/// What a triangle mesh is as a topological space and a solid; brute force.
struct MeshFacts {
    size_t edges = 0;
    size_t open_edges = 0;       ///< of one triangle only
    size_t crowded_edges = 0;    ///< of three triangles and more
    size_t turned_edges = 0;     ///< of two triangles that walk it in the same direction: they face opposite sides
    size_t unused_vertices = 0;  ///< of no triangle
    size_t flat_triangles = 0;   ///< with a corner twice, or no area
    int64_t euler_number = 0;    ///< used vertices - edges + triangles
    double area_m2 = 0;
    double volume_m3 = 0;  ///< enclosed, positive for counter-clockwise triangles seen from outside

    bool closed() const { return open_edges + crowded_edges + turned_edges == 0; }
};

MeshFacts mesh_facts(std::span<const glm::vec3> positions_m, std::span<const std::array<uint32_t, 3>> triangles);

/// The triangles that hang together by shared vertices, of the largest such part.
std::vector<std::array<uint32_t, 3>> largest_component(std::span<const std::array<uint32_t, 3>> triangles);

}  // namespace patina::reference
