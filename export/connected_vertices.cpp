#include "export/connected_vertices.h"

#include <algorithm>
#include <numeric>

#include "export/same_positions.h"

namespace patina {

ConnectedVertices::ConnectedVertices(std::span<const glm::vec3> positions_m,
                                     std::span<const std::array<uint32_t, 3>> triangles,
                                     std::span<const uint32_t> labels)
    : parent_(positions_m.size()) {
    std::iota(parent_.begin(), parent_.end(), 0u);
    const auto join_alike = [&](uint32_t a, uint32_t b) {
        if (labels.empty() || labels[a] == labels[b]) join(a, b);
    };
    const std::vector<uint32_t> first = first_of_position(positions_m);
    for (uint32_t i = 0; i < first.size(); ++i) join_alike(i, first[i]);
    for (const auto& [a, b, c] : triangles) {
        join_alike(a, b);
        join_alike(b, c);
        join_alike(c, a);
    }
}

uint32_t ConnectedVertices::part_of(uint32_t vertex) {
    while (parent_[vertex] != vertex) vertex = parent_[vertex] = parent_[parent_[vertex]];
    return vertex;
}

void ConnectedVertices::join(uint32_t a, uint32_t b) {
    const auto [low, high] = std::minmax({part_of(a), part_of(b)});
    parent_[high] = low;
}

}  // namespace patina
