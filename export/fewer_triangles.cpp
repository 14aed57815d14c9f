#include "export/fewer_triangles.h"

#include <utility>

#include <meshoptimizer.h>

#include "engine/core/used_vertices.h"
#include "export/mesh_parts.h"

namespace patina {

namespace {

/// Triangles name the first vertex of each position.
void weld(std::span<const glm::vec3> positions_m, std::vector<std::array<uint32_t, 3>>& triangles) {
    constexpr uint32_t kNone = UINT32_MAX;
    std::vector<uint32_t> place(positions_m.size()), first(positions_m.size(), kNone);
    meshopt_generateVertexRemap(place.data(), triangles.front().data(), 3 * triangles.size(), positions_m.data(),
                                positions_m.size(), sizeof(glm::vec3));
    for (auto& triangle : triangles) {
        for (uint32_t& vertex : triangle) {
            uint32_t& own = first[place[vertex]];
            if (own == kNone) own = vertex;
            vertex = own;
        }
    }
}

}  // namespace

std::vector<uint32_t> collapse(std::span<const glm::vec3> positions_m, std::vector<std::array<uint32_t, 3>>& triangles,
                               double part, Seams seams) {
    constexpr float kAnyError = 1;  // of the surface's own size
    if (!triangles.empty()) {
        if (seams == Seams::kWelded) weld(positions_m, triangles);
        const size_t count = 3 * triangles.size();
        std::vector<std::array<uint32_t, 3>> kept(triangles.size());
        float error = 0;
        const size_t indices = meshopt_simplify(kept.front().data(), triangles.front().data(), count,
                                                &positions_m.front().x, positions_m.size(), sizeof(glm::vec3),
                                                static_cast<size_t>(static_cast<double>(count) * part), kAnyError,
                                                meshopt_SimplifyLockBorder, &error);
        kept.resize(indices / 3);
        triangles = std::move(kept);
    }
    return number_used(triangles, positions_m.size());
}

SceneParts with_fewer_triangles(SceneParts scene, uint64_t triangles) {
    const uint64_t before = scene.triangles();
    if (triangles >= before) return scene;
    const double share = static_cast<double>(triangles) / static_cast<double>(before);
    for (ScenePart& part : scene.parts) {
        MeshPart used;
        used.vertices = collapse(part.positions_m, part.triangles, share);
        part.positions_m = gathered(part.positions_m, used);
        part.normals = gathered(part.normals, used);
        if (!part.base.empty()) part.base = gathered(part.base, used);
        if (!part.places.empty()) part.places = gathered(part.places, used);
    }
    return scene;
}

}  // namespace patina
