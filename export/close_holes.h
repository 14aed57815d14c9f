#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "patina/scene.h"

namespace patina {

/// Which holes are closed.
struct HoleOptions {
    double most_m = 0.05;  ///< diagonal of the box around a hole's border; larger holes stay open
    /// Whether the mesh may be a piece of a surface that others go on from: then what is open at its sides is no hole.
    bool in_pieces = true;
};

/// Triangles that close holes, and the vertices they use: copies of vertices of the mesh, so that they can be told
/// apart.
struct HoleFilling {
    std::vector<uint32_t> vertices;                  ///< of the mesh
    std::vector<std::array<uint32_t, 3>> triangles;  ///< of the numbers within `vertices`
    uint64_t holes = 0;
};

/// Closes holes of a surface: of the triangles over a hole's border, those of the least area (Barequet and Sharir 1995,
/// "Filling gaps in the boundary of a polyhedron"). A border is a loop of edges that one triangle has; vertices of one
/// position are one. The outer border of a part is none: what would close it faces the other way. No edge gets a third
/// triangle; where that cannot be avoided, the hole stays open.
HoleFilling close_holes(const Mesh& mesh, const HoleOptions& options);

}  // namespace patina
