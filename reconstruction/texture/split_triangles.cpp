#include "reconstruction/texture/split_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace patina {
namespace {

using Corners = std::array<uint32_t, 3>;

template <class Value>
void add_mean(std::vector<Value>& values, const Corners& corners, glm::vec3 shares) {
    if (values.empty()) return;
    values.push_back(shares[0] * values[corners[0]] + shares[1] * values[corners[1]] + shares[2] * values[corners[2]]);
}

/// Adds a vertex between three, and returns its number.
uint32_t add_vertex(TexturedSurface& surface, const Corners& corners, glm::vec3 shares) {
    Mesh& mesh = surface.mesh;
    const auto added = static_cast<uint32_t>(mesh.positions_m.size());
    add_mean(mesh.positions_m, corners, shares);
    add_mean(mesh.normals, corners, shares);
    add_mean(mesh.colors, corners, shares);
    add_mean(surface.place_px, corners, shares);
    const float length = glm::length(mesh.normals.back());
    if (length > 0) mesh.normals.back() /= length;
    surface.pages.push_back(surface.pages[corners[0]]);
    MeshReflectance& reflectance = surface.reflectance;
    if (reflectance.kd.empty()) return added;
    const bool known = std::ranges::all_of(corners, [&](uint32_t i) { return reflectance.kd[i].a > 0; });
    add_mean(reflectance.kd, corners, shares);
    if (!known) reflectance.kd.back() = glm::vec4(0);
    reflectance.labels.push_back(reflectance.labels[corners[0]]);
    return added;
}

/// Cuts a triangle into bands along its shortest edge, which is opposite the first corner, and bands into quads.
void add_parts(TexturedSurface& surface, const Corners& corners, uint32_t bands, double base_parts) {
    const auto at = [&](uint32_t line, uint32_t part, uint32_t parts) {
        const float along = static_cast<float>(line) / static_cast<float>(bands);
        const float across = static_cast<float>(part) / static_cast<float>(parts);
        return add_vertex(surface, corners, {1 - along, along * (1 - across), along * across});
    };
    for (uint32_t band = 0; band < bands; ++band) {
        const double width = base_parts * (band + 1) / bands;
        const auto parts = static_cast<uint32_t>(std::max(std::ceil(width - 1e-6), 1.0));
        uint32_t upper = at(band, 0, parts), lower = at(band + 1, 0, parts);
        for (uint32_t part = 1; part <= parts; ++part) {
            const uint32_t next_lower = at(band + 1, part, parts),
                           next_upper = band > 0 ? at(band, part, parts) : upper;
            surface.mesh.triangles.push_back({upper, lower, next_lower});
            if (band > 0) surface.mesh.triangles.push_back({upper, next_lower, next_upper});
            upper = next_upper;
            lower = next_lower;
        }
    }
}

}  // namespace

TexturedSurface with_short_edges(const TexturedSurface& surface, double longest_m) {
    TexturedSurface split = surface;
    split.filled.clear();
    split.mesh.triangles.clear();
    const std::vector<glm::vec3>& positions_m = surface.mesh.positions_m;
    for (const Corners& corners : surface.mesh.triangles) {
        std::array<double, 3> opposite_m{};  // the edge opposite each corner
        for (size_t i = 0; i < 3; ++i) {
            opposite_m[i] = double{glm::distance(positions_m[corners[(i + 1) % 3]], positions_m[corners[(i + 2) % 3]])};
        }
        const auto [shortest, longest] = std::ranges::minmax_element(opposite_m);
        const double bands = std::ceil(*longest / longest_m - 1e-6);
        if (bands <= 1) {
            split.mesh.triangles.push_back(corners);
            continue;
        }
        Corners turned = corners;
        std::ranges::rotate(turned, turned.begin() + (shortest - opposite_m.begin()));
        add_parts(split, turned, static_cast<uint32_t>(bands), *shortest / longest_m);
    }
    return split;
}

}  // namespace patina
