#include "engine/core/used_vertices.h"

namespace patina {

std::vector<uint32_t> number_used(std::span<std::array<uint32_t, 3>> triangles, size_t vertices) {
    std::vector<uint32_t> number(vertices, 0), used;
    for (const auto& triangle : triangles) {
        for (const uint32_t vertex : triangle) number[vertex] = 1;
    }
    for (uint32_t vertex = 0; vertex < vertices; ++vertex) {
        if (number[vertex] == 0) continue;
        number[vertex] = static_cast<uint32_t>(used.size());
        used.push_back(vertex);
    }
    for (auto& triangle : triangles) {
        for (uint32_t& vertex : triangle) vertex = number[vertex];
    }
    return used;
}

}  // namespace patina
