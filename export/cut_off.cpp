#include "export/cut_off.h"

#include <algorithm>
#include <array>

namespace patina {

std::vector<bool> cut_off_parts(std::span<const glm::vec3> positions_m, std::span<const uint32_t> part) {
    glm::vec3 low(1e9f), high(-1e9f);
    for (const glm::vec3& position : positions_m) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    std::vector<std::array<uint32_t, 6>> at_sides(positions_m.size());
    for (size_t i = 0; i < positions_m.size(); ++i) {
        for (uint32_t axis = 0; axis < 3; ++axis) {
            const auto at = static_cast<glm::length_t>(axis);
            at_sides[part[i]][axis] += positions_m[i][at] == low[at];
            at_sides[part[i]][3 + axis] += positions_m[i][at] == high[at];
        }
    }
    std::vector<bool> cut_off;
    cut_off.reserve(at_sides.size());
    for (const std::array<uint32_t, 6>& sides : at_sides)
        cut_off.push_back(std::ranges::any_of(sides, [](uint32_t vertices) { return vertices >= 2; }));
    return cut_off;
}

}  // namespace patina
