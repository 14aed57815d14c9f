#include "tools/figure/polygonise.h"

#include <cmath>
#include <map>
#include <vector>

#include "passes/surface/case_table.h"

namespace patina::figure {
namespace {

constexpr double kStep = 1e-5;   // of the central differences; the error is its square
constexpr int kRelaxations = 8;  // enough that no triangle is a sliver
constexpr int kNewtonSteps = 4;  // an ellipsoid's distance is no exact one, so that one step does not do

/// Distances at a grid's corners.
class Grid {
  public:
    Grid(const Distance& distance, glm::dvec3 low, glm::dvec3 high, double cell)
        : low_(low), cell_(cell), cells_(glm::ceil((high - low) / cell)) {
        for (uint32_t z = 0; z <= cells_.z; ++z)
            for (uint32_t y = 0; y <= cells_.y; ++y)
                for (uint32_t x = 0; x <= cells_.x; ++x) distances_.push_back(distance(place({x, y, z})));
    }

    glm::uvec3 cells() const { return cells_; }
    glm::dvec3 place(glm::uvec3 corner) const { return low_ + cell_ * glm::dvec3(corner); }
    uint32_t index(glm::uvec3 corner) const {
        return (corner.z * (cells_.y + 1) + corner.y) * (cells_.x + 1) + corner.x;
    }
    double distance(glm::uvec3 corner) const { return distances_[index(corner)]; }

  private:
    glm::dvec3 low_;
    double cell_;
    glm::uvec3 cells_;
    std::vector<double> distances_;
};

glm::uvec3 corner_of(uint32_t code) { return {code & 1, code >> 1 & 1, code >> 2 & 1}; }

uint32_t case_of(const Grid& grid, glm::uvec3 cell) {
    uint32_t which = 0;
    for (uint32_t i = 0; i < 8; ++i) which |= (grid.distance(cell + corner_of(i)) < 0 ? 1u : 0u) << i;
    return which;
}

struct Polygons {
    std::vector<glm::dvec3> places;
    std::vector<glm::uvec3> triangles;
};

/// Marching cubes; cells share the vertices on their edges.
class Marcher {
  public:
    explicit Marcher(const Grid& grid) : grid_(grid) {
        const glm::uvec3 cells = grid.cells();
        for (uint32_t z = 0; z < cells.z; ++z)
            for (uint32_t y = 0; y < cells.y; ++y)
                for (uint32_t x = 0; x < cells.x; ++x) add_cell({x, y, z});
    }
    Polygons take() { return std::move(polygons_); }

  private:
    void add_cell(glm::uvec3 cell) {
        for (const surface::CaseTriangle& triangle : surface::case_triangles(case_of(grid_, cell)))
            polygons_.triangles.emplace_back(vertex(cell, triangle[0]), vertex(cell, triangle[1]),
                                             vertex(cell, triangle[2]));
    }

    uint32_t vertex(glm::uvec3 cell, uint32_t edge) {
        const glm::uvec3 a = cell + corner_of(edge & 7);
        const auto axis = static_cast<int>(edge >> 3);
        const auto [found, is_new] =
            vertices_.try_emplace({grid_.index(a), axis}, static_cast<uint32_t>(polygons_.places.size()));
        if (is_new) {
            glm::uvec3 b = a;
            ++b[axis];
            const double at_a = grid_.distance(a), at_b = grid_.distance(b);
            polygons_.places.push_back(glm::mix(grid_.place(a), grid_.place(b), at_a / (at_a - at_b)));
        }
        return found->second;
    }

    const Grid& grid_;
    Polygons polygons_;
    std::map<std::pair<uint32_t, int>, uint32_t> vertices_;  ///< by lower corner and axis of the edge
};

glm::dvec3 gradient(const Distance& distance, glm::dvec3 p) {
    glm::dvec3 slope;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 step(0);
        step[axis] = kStep;
        slope[axis] = (distance(p + step) - distance(p - step)) / (2 * kStep);
    }
    return slope;
}

glm::dvec3 pulled_onto_surface(const Distance& distance, glm::dvec3 p) {
    for (int i = 0; i < kNewtonSteps; ++i) {
        const glm::dvec3 slope = gradient(distance, p);
        p -= distance(p) / glm::dot(slope, slope) * slope;
    }
    return p;
}

/// Moves every vertex to the middle of its neighbours, weighted by their common triangles.
void relax(Polygons& polygons) {
    std::vector<glm::dvec3> sums(polygons.places.size(), glm::dvec3(0));
    std::vector<uint32_t> counts(polygons.places.size(), 0);
    for (const glm::uvec3& triangle : polygons.triangles) {
        for (int i = 0; i < 3; ++i) {
            const uint32_t corner = triangle[i];
            sums[corner] += polygons.places[triangle[(i + 1) % 3]] + polygons.places[triangle[(i + 2) % 3]];
            counts[corner] += 2;
        }
    }
    for (size_t i = 0; i < sums.size(); ++i) polygons.places[i] = sums[i] / double(counts[i]);
}

}  // namespace

glm::dvec3 surface_normal(const Distance& distance, glm::dvec3 p) { return glm::normalize(gradient(distance, p)); }

scenes::TriangleMesh polygonise(const Distance& distance, glm::dvec3 low, glm::dvec3 high, double cell) {
    Polygons polygons = Marcher(Grid(distance, low, high, cell)).take();
    for (int i = 0; i < kRelaxations; ++i) {
        relax(polygons);
        for (glm::dvec3& p : polygons.places) p = pulled_onto_surface(distance, p);
    }
    scenes::TriangleMesh mesh;
    for (const glm::dvec3& p : polygons.places) {
        mesh.positions_m.emplace_back(p);
        mesh.normals.emplace_back(surface_normal(distance, p));
    }
    mesh.triangles = std::move(polygons.triangles);
    return mesh;
}

}  // namespace patina::figure
