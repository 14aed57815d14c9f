#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace patina {

/// The vertices of `vertices` that triangles use, ascending; the triangles then name them by their places in that list.
std::vector<uint32_t> number_used(std::span<std::array<uint32_t, 3>> triangles, size_t vertices);

}  // namespace patina
