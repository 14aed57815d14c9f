#include "reconstruction/texture/split_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace patina {
namespace {

/// The mean of three vertices' values, weighted.
template <class Value>
Value mean_of(const std::vector<Value>& values, const std::array<uint32_t, 3>& corners, glm::vec3 shares) {
    return shares[0] * values[corners[0]] + shares[1] * values[corners[1]] + shares[2] * values[corners[2]];
}

class Splitter {
  public:
    explicit Splitter(const TexturedSurface& whole) : whole_(whole), split(whole) { split.mesh.triangles.clear(); }

    void add(const std::array<uint32_t, 3>& corners, uint32_t parts) {
        if (parts == 1) {
            split.mesh.triangles.push_back(corners);
            return;
        }
        // Vertices in rows, from the first corner on: row r has r + 1 of them.
        const auto first = static_cast<uint32_t>(split.mesh.positions_m.size());
        for (uint32_t row = 0; row <= parts; ++row) {
            for (uint32_t column = 0; column <= row; ++column) {
                add_vertex(corners, glm::vec3(parts - row, row - column, column) / static_cast<float>(parts));
            }
        }
        const auto at = [&](uint32_t row, uint32_t column) { return first + row * (row + 1) / 2 + column; };
        for (uint32_t row = 0; row < parts; ++row) {
            for (uint32_t column = 0; column <= row; ++column) {
                split.mesh.triangles.push_back({at(row, column), at(row + 1, column), at(row + 1, column + 1)});
                if (column == row) continue;
                split.mesh.triangles.push_back({at(row, column), at(row + 1, column + 1), at(row, column + 1)});
            }
        }
    }

  private:
    void add_vertex(const std::array<uint32_t, 3>& corners, glm::vec3 shares) {
        const Mesh& mesh = whole_.mesh;
        split.mesh.positions_m.push_back(mean_of(mesh.positions_m, corners, shares));
        const glm::vec3 normal = mean_of(mesh.normals, corners, shares);
        const float length = glm::length(normal);
        split.mesh.normals.push_back(length > 0 ? normal / length : normal);
        if (!mesh.colors.empty()) split.mesh.colors.push_back(mean_of(mesh.colors, corners, shares));
        split.place_px.push_back(mean_of(whole_.place_px, corners, shares));
        split.pages.push_back(whole_.pages[corners[0]]);
        if (whole_.reflectance.kd.empty()) return;
        split.reflectance.kd.push_back(whole_.reflectance.kd[corners[0]]);
        split.reflectance.labels.push_back(whole_.reflectance.labels[corners[0]]);
    }

    const TexturedSurface& whole_;

  public:
    TexturedSurface split;
};

}  // namespace

TexturedSurface with_short_edges(const TexturedSurface& surface, double longest_m) {
    Splitter splitter(surface);
    const std::vector<glm::vec3>& positions_m = surface.mesh.positions_m;
    for (const auto& corners : surface.mesh.triangles) {
        double longest = 0;
        for (size_t i = 0; i < 3; ++i) {
            longest =
                std::max(longest, double{glm::distance(positions_m[corners[i]], positions_m[corners[(i + 1) % 3]])});
        }
        splitter.add(corners, static_cast<uint32_t>(std::max(std::ceil(longest / longest_m - 1e-6), 1.0)));
    }
    return std::move(splitter.split);
}

}  // namespace patina
