#include "scenes/description/bumps.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "engine/core/error.h"
#include "scenes/description/draws.h"
#include "scenes/description/mesh.h"

namespace patina::scenes {

namespace {

constexpr double kEdges = 4;  // from one bump to the next, in the mean
constexpr size_t kMostTriangles = 4'000'000;

double mean_edge_m(const TriangleMesh& mesh) {
    double sum_m = 0;
    for (const glm::uvec3 t : mesh.triangles) {
        for (const auto& [a, b] : {std::pair(t.x, t.y), {t.y, t.z}, {t.z, t.x}})
            sum_m += glm::distance(glm::dvec3(mesh.positions_m[a]), glm::dvec3(mesh.positions_m[b]));
    }
    return sum_m / static_cast<double>(3 * mesh.triangles.size());
}

/// Each triangle in four, at the middles of its edges.
TriangleMesh divided(const TriangleMesh& mesh) {
    TriangleMesh finer{mesh.positions_m, {}, mesh.texture_coordinates, {}};
    finer.triangles.reserve(4 * mesh.triangles.size());
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
        const auto [entry, is_new] =
            middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(finer.positions_m.size()));
        if (!is_new) return entry->second;
        finer.positions_m.push_back(0.5f * (mesh.positions_m[a] + mesh.positions_m[b]));
        if (!mesh.texture_coordinates.empty())
            finer.texture_coordinates.push_back(0.5f * (mesh.texture_coordinates[a] + mesh.texture_coordinates[b]));
        return entry->second;
    };
    for (const glm::uvec3 t : mesh.triangles) {
        const uint32_t xy = middle(t.x, t.y), yz = middle(t.y, t.z), zx = middle(t.z, t.x);
        for (const glm::uvec3 part : {glm::uvec3(t.x, xy, zx), {xy, t.y, yz}, {zx, yz, t.z}, {xy, yz, zx}})
            finer.triangles.push_back(part);
    }
    return finer;
}

/// Values from -1 to 1 at whole numbers, with a smooth blend between.
class LatticeNoise {
  public:
    explicit LatticeNoise(uint64_t seed) : seed_(seed) {}

    double at(glm::dvec3 point) const {
        const glm::dvec3 low = glm::floor(point), t = point - low;
        const glm::dvec3 blend = t * t * t * (t * (6.0 * t - 15.0) + 10.0);
        double sum = 0;
        for (int i = 0; i < 8; ++i) {
            const glm::ivec3 corner(i & 1, i >> 1 & 1, i >> 2);
            const glm::dvec3 share = glm::mix(1.0 - blend, blend, glm::dvec3(corner));
            sum += share.x * share.y * share.z * value(glm::ivec3(low) + corner);
        }
        return sum;
    }

  private:
    double value(glm::ivec3 corner) const {
        constexpr uint64_t kMask = (uint64_t{1} << 21) - 1;
        const auto part = [](int x) { return static_cast<uint64_t>(x) & kMask; };
        return Draws(seed_, "bump", part(corner.x) | part(corner.y) << 21 | part(corner.z) << 42).between(-1, 1);
    }

    uint64_t seed_;
};

}  // namespace

TriangleMesh with_bumps(TriangleMesh mesh, const Bumps& bumps) {
    while (mean_edge_m(mesh) > bumps.size_m / kEdges) {
        if (4 * mesh.triangles.size() > kMostTriangles)
            throw Error("bumps of ", bumps.size_m, " m would take more than ", kMostTriangles, " triangles");
        mesh = divided(mesh);
    }
    mesh = with_smooth_normals(std::move(mesh));
    const LatticeNoise coarse(bumps.seed), fine(bumps.seed + 1);
    for (size_t i = 0; i < mesh.positions_m.size(); ++i) {
        const glm::dvec3 at = glm::dvec3(mesh.positions_m[i]) / bumps.size_m;
        const double height_m = bumps.depth_m / 2 * (2 * coarse.at(at) + fine.at(2.0 * at)) / 3;
        mesh.positions_m[i] += static_cast<float>(height_m) * mesh.normals[i];
    }
    check_triangles(mesh);
    return with_smooth_normals(std::move(mesh));
}

}  // namespace patina::scenes
