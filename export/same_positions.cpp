#include "export/same_positions.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace patina {

std::vector<uint32_t> first_of_position(std::span<const glm::vec3> positions_m) {
    std::vector<uint32_t> order(positions_m.size()), first(positions_m.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, {}, [&](uint32_t vertex) {
        const glm::vec3 p = positions_m[vertex];
        return std::tuple(p.x, p.y, p.z, vertex);
    });
    for (size_t i = 0; i < order.size(); ++i) {
        const bool again = i > 0 && positions_m[order[i]] == positions_m[order[i - 1]];
        first[order[i]] = again ? first[order[i - 1]] : order[i];
    }
    return first;
}

}  // namespace patina
