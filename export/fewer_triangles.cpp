#include "export/fewer_triangles.h"

#include <algorithm>
#include <span>
#include <utility>

#include <meshoptimizer.h>

#include "engine/core/used_vertices.h"
#include "export/mesh_parts.h"

namespace patina {

namespace {

using Triangle = std::array<uint32_t, 3>;

std::vector<Triangle> simplified(std::span<const glm::vec3> positions_m, const std::vector<Triangle>& triangles,
                                 double share) {
    constexpr float kAnyError = 1;  // of the surface's own size
    if (triangles.empty()) return {};
    const size_t count = 3 * triangles.size();
    std::vector<Triangle> kept(triangles.size());
    float error = 0;
    const size_t indices = meshopt_simplify(
        kept.front().data(), triangles.front().data(), count, &positions_m.front().x, positions_m.size(),
        sizeof(glm::vec3), static_cast<size_t>(static_cast<double>(count) * share), kAnyError, 0, &error);
    kept.resize(indices / 3);
    return kept;
}

/// All parts as one surface.
struct Joined {
    std::vector<glm::vec3> positions_m;
    std::vector<Triangle> triangles;
    std::vector<uint32_t> first;    ///< by part: the number of its first vertex
    std::vector<uint32_t> part_of;  ///< by vertex

    explicit Joined(const std::vector<PartSurface>& parts) {
        for (uint32_t i = 0; i < parts.size(); ++i) {
            const auto offset = static_cast<uint32_t>(positions_m.size());
            first.push_back(offset);
            positions_m.insert(positions_m.end(), parts[i].positions_m.begin(), parts[i].positions_m.end());
            part_of.insert(part_of.end(), parts[i].positions_m.size(), i);
            for (const auto& [a, b, c] : parts[i].triangles) triangles.push_back({a + offset, b + offset, c + offset});
        }
    }

    /// Whether all of a triangle's vertices are of one part.
    bool is_whole(const Triangle& triangle) const {
        return part_of[triangle[0]] == part_of[triangle[1]] && part_of[triangle[0]] == part_of[triangle[2]];
    }
};

}  // namespace

std::vector<std::vector<uint32_t>> collapse(std::vector<PartSurface>& parts, double share) {
    const Joined joined(parts);
    const std::vector<Triangle> left = simplified(joined.positions_m, joined.triangles, share);
    std::vector<std::vector<Triangle>> by_part(parts.size());
    for (const Triangle& triangle : left) {
        if (!joined.is_whole(triangle)) continue;
        const uint32_t part = joined.part_of[triangle[0]], first = joined.first[part];
        by_part[part].push_back({triangle[0] - first, triangle[1] - first, triangle[2] - first});
    }
    std::vector<std::vector<uint32_t>> kept;
    for (size_t i = 0; i < parts.size(); ++i) {
        if (!by_part[i].empty()) parts[i].triangles = std::move(by_part[i]);
        kept.push_back(number_used(parts[i].triangles, parts[i].positions_m.size()));
    }
    return kept;
}

SceneParts with_fewer_triangles(SceneParts scene, uint64_t triangles) {
    const uint64_t before = scene.triangles();
    if (triangles >= before) return scene;
    std::vector<PartSurface> surfaces;
    for (ScenePart& part : scene.parts) surfaces.push_back({part.positions_m, std::move(part.triangles)});
    const auto kept = collapse(surfaces, static_cast<double>(triangles) / static_cast<double>(before));
    for (size_t i = 0; i < scene.parts.size(); ++i) {
        ScenePart& part = scene.parts[i];
        const MeshPart used{0, kept[i], {}};
        part.triangles = std::move(surfaces[i].triangles);
        part.positions_m = gathered(part.positions_m, used);
        part.normals = gathered(part.normals, used);
        if (!part.base.empty()) part.base = gathered(part.base, used);
        if (!part.places.empty()) part.places = gathered(part.places, used);
    }
    return scene;
}

}  // namespace patina
