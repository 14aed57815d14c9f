#include "tests/reference/surface/marching_cubes.h"

#include <algorithm>
#include <utility>

namespace patina::reference {

namespace {

using Point = std::array<int, 3>;

Point corner_of(Point cell, int corner) {
    return {cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2)};
}

/// The distances at a cell's corners; empty unless all have been seen.
std::vector<float> corners_of(const Lattice& lattice, Point cell) {
    std::vector<float> distances;
    for (int corner = 0; corner < 8; ++corner) {
        const auto found = lattice.find(corner_of(cell, corner));
        if (found == lattice.end()) return {};
        distances.push_back(found->second);
    }
    return distances;
}

}  // namespace

std::vector<glm::vec3> surface_vertices(const Lattice& lattice) {
    std::map<std::pair<Point, int>, glm::vec3> by_edge;
    for (const auto& [cell, distance] : lattice) {
        const std::vector<float> distances = corners_of(lattice, cell);
        if (distances.empty()) continue;
        for (int low = 0; low < 8; ++low) {
            for (int axis = 0; axis < 3; ++axis) {
                const int high = low | 1 << axis;
                const float from = distances[static_cast<size_t>(low)], to = distances[static_cast<size_t>(high)];
                if (high == low || (from <= 0) == (to <= 0)) continue;
                const Point start = corner_of(cell, low);
                glm::vec3 vertex(start[0], start[1], start[2]);
                vertex[axis] += std::clamp(from / (from - to), 0.001f, 0.999f);
                by_edge[{start, axis}] = vertex;
            }
        }
    }
    std::vector<glm::vec3> vertices;
    for (const auto& [edge, vertex] : by_edge) vertices.push_back(vertex);
    return vertices;
}

}  // namespace patina::reference
