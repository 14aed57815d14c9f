#include "export/coarser_mesh.h"

#include <algorithm>
#include <array>

#include <meshoptimizer.h>

#include "engine/core/luminance.h"
#include "engine/core/used_vertices.h"

namespace patina {

std::vector<float> shades_of(const Mesh& mesh, const MeshReflectance& reflectance) {
    std::vector<float> shades;
    for (size_t i = 0; i < mesh.colors.size(); ++i) {
        const bool known = !reflectance.kd.empty() && reflectance.kd[i].a > 0;
        shades.push_back(luminance(known ? glm::vec3(reflectance.kd[i]) : mesh.colors[i]));
    }
    return shades;
}

CoarserMesh coarser(const Mesh& mesh, std::span<const float> shades, const Coarseness& coarseness) {
    CoarserMesh result;
    if (mesh.triangles.empty()) return result;
    const size_t count = 3 * mesh.triangles.size(), vertices = mesh.positions_m.size();
    // A step of the shade becomes one of the surface.
    std::vector<glm::vec3> raised(vertices);
    for (size_t i = 0; i < vertices; ++i)
        raised[i] = mesh.positions_m[i] + coarseness.white_m * std::clamp(shades[i], 0.0f, 1.0f) * mesh.normals[i];
    const float* positions = &raised.front().x;
    std::vector<std::array<uint32_t, 3>> triangles(mesh.triangles.size());
    const double scale_m = double{meshopt_simplifyScale(positions, vertices, sizeof(glm::vec3))};
    const auto most_error = static_cast<float>(std::min(coarseness.error_m / std::max(scale_m, 1e-9), 1.0));
    const unsigned options = coarseness.locks_border ? static_cast<unsigned>(meshopt_SimplifyLockBorder) : 0;
    float error = 0;
    const size_t kept = meshopt_simplify(
        triangles.front().data(), mesh.triangles.front().data(), count, positions, vertices, sizeof(glm::vec3),
        static_cast<size_t>(static_cast<double>(count) * coarseness.part), most_error, options, &error);
    triangles.resize(kept / 3);
    result.error_m = double{error} * scale_m;

    result.vertices = number_used(triangles, vertices);
    for (const uint32_t vertex : result.vertices) {
        result.mesh.positions_m.push_back(mesh.positions_m[vertex]);
        result.mesh.normals.push_back(mesh.normals[vertex]);
        result.mesh.colors.push_back(mesh.colors[vertex]);
    }
    result.mesh.triangles = std::move(triangles);
    return result;
}

}  // namespace patina
