#include "tests/reference/surface/mesh_facts.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace patina::reference {

MeshFacts mesh_facts(std::span<const glm::vec3> positions_m, std::span<const std::array<uint32_t, 3>> triangles) {
    MeshFacts facts;
    std::map<std::pair<uint32_t, uint32_t>, std::pair<size_t, size_t>> edges;  // walked upwards, downwards
    std::vector<bool> used(positions_m.size(), false);
    for (const auto& triangle : triangles) {
        std::array<glm::dvec3, 3> corner;
        for (size_t i = 0; i < 3; ++i) {
            const uint32_t from = triangle[i], to = triangle[(i + 1) % 3];
            auto& walks = edges[std::minmax(from, to)];
            ++(from < to ? walks.first : walks.second);
            used.at(from) = true;
            corner[i] = glm::dvec3(positions_m[from]);
        }
        const double area = 0.5 * glm::length(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
        facts.flat_triangles += !(area > 0);
        facts.area_m2 += area;
        facts.volume_m3 += glm::dot(corner[0], glm::cross(corner[1], corner[2])) / 6;
    }
    for (const auto& [ends, walks] : edges) {
        facts.open_edges += walks.first + walks.second == 1;
        facts.crowded_edges += walks.first + walks.second > 2;
        facts.turned_edges += walks.first == 2 || walks.second == 2;
    }
    facts.edges = edges.size();
    facts.unused_vertices = static_cast<size_t>(std::count(used.begin(), used.end(), false));
    const size_t used_vertices = positions_m.size() - facts.unused_vertices;
    facts.euler_number = static_cast<int64_t>(used_vertices + triangles.size()) - static_cast<int64_t>(edges.size());
    return facts;
}

std::vector<std::array<uint32_t, 3>> largest_component(std::span<const std::array<uint32_t, 3>> triangles) {
    uint32_t vertices = 0;
    for (const auto& triangle : triangles)
        vertices = std::max({vertices, triangle[0] + 1, triangle[1] + 1, triangle[2] + 1});
    std::vector<uint32_t> parent(vertices);
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](uint32_t vertex) {
        while (parent[vertex] != vertex) vertex = parent[vertex] = parent[parent[vertex]];
        return vertex;
    };
    for (const auto& [a, b, c] : triangles) {
        parent[root(a)] = root(c);
        parent[root(b)] = root(c);
    }

    std::map<uint32_t, std::vector<std::array<uint32_t, 3>>> parts;
    for (const auto& triangle : triangles) parts[root(triangle[0])].push_back(triangle);
    const auto by_size = [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); };
    const auto largest = std::max_element(parts.begin(), parts.end(), by_size);
    return largest == parts.end() ? std::vector<std::array<uint32_t, 3>>{} : largest->second;
}

}  // namespace patina::reference
