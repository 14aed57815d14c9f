#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "export/scene_parts.h"

namespace patina {

/// A part of a surface that has vertices of its own.
struct PartSurface {
    std::vector<glm::vec3> positions_m;
    std::vector<std::array<uint32_t, 3>> triangles;
};

/// Collapses edges of a whole surface until about `share` of the triangles are left (meshoptimizer). Vertices are some
/// of those there were: by part their numbers are returned, by which the triangles name them then. Parts that meet in
/// vertices of one position still do. Where three of them meet nothing moves, so that more may be left. A part of which
/// nothing would be left stays as it is.
std::vector<std::vector<uint32_t>> collapse(std::vector<PartSurface>& parts, double share);

/// The surface with about so many triangles, as collapse() makes it.
SceneParts with_fewer_triangles(SceneParts scene, uint64_t triangles);

}  // namespace patina
