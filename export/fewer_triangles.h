#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "export/scene_parts.h"

namespace patina {

/// Collapses edges until about `part` of the triangles are left. Vertices are some of those there were; their numbers
/// are returned, by which the triangles name them then. Open borders stay, so that what meets there still does, and so
/// do borders of charts, whose vertices have the same positions (meshoptimizer).
std::vector<uint32_t> collapse(std::span<const glm::vec3> positions_m, std::vector<std::array<uint32_t, 3>>& triangles,
                               double part);

/// The surface with about so many triangles, or with as few as its borders allow.
SceneParts with_fewer_triangles(SceneParts scene, uint64_t triangles);

}  // namespace patina
