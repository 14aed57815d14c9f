#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace patina {

/// By part (the value of `part`, by vertex, is below the number of vertices): whether an end of the piece of surface
/// cuts it off. Where a piece ends at a plane, vertices lie exactly in it, and none beyond: so two of the part's lie on
/// a side of the box around all vertices.
std::vector<bool> cut_off_parts(std::span<const glm::vec3> positions_m, std::span<const uint32_t> part);

}  // namespace patina
