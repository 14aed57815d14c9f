#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "export/scene_parts.h"

namespace patina {

/// What becomes of vertices that have one position, where charts of a texture meet.
enum class Seams {
    kStay,   ///< they stay two
    kWelded  ///< one of them stays, where it does not matter which
};

/// Collapses edges until about `part` of the triangles are left. Vertices are some of those there were; their numbers
/// are returned, by which the triangles name them then. Open borders stay, so that what meets there still does
/// (meshoptimizer).
std::vector<uint32_t> collapse(std::span<const glm::vec3> positions_m, std::vector<std::array<uint32_t, 3>>& triangles,
                               double part, Seams seams = Seams::kStay);

/// The surface with about so many triangles, or with as few as its borders allow.
SceneParts with_fewer_triangles(SceneParts scene, uint64_t triangles);

}  // namespace patina
