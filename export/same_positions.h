#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace patina {

/// By vertex, the first one of the same position: what meets there is one to whoever uses these numbers.
std::vector<uint32_t> first_of_position(std::span<const glm::vec3> positions_m);

}  // namespace patina
