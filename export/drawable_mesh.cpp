#include "export/drawable_mesh.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "engine/core/error.h"

namespace patina {
namespace {

using Triangle = std::array<uint32_t, 3>;

bool finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check_finite(const std::filesystem::path& path, const char* what, std::span<const glm::vec3> values) {
    const auto bad = std::ranges::find_if_not(values, finite);
    if (bad == values.end()) return;
    throw Error(path, ": the ", what, " of vertex ", bad - values.begin(), " of ", values.size(), " is not finite: (",
                bad->x, ", ", bad->y, ", ", bad->z, ")");
}

/// Twice the triangle's area along its normal. Float differences are exact in double, so that coinciding and (but for
/// extreme scales) collinear corners give exactly zero.
glm::dvec3 area_vector(const Mesh& mesh, const Triangle& t) {
    const glm::dvec3 a(mesh.positions_m[t[0]]), b(mesh.positions_m[t[1]]), c(mesh.positions_m[t[2]]);
    return glm::cross(b - a, c - a);
}

/// The sum of the area vectors around each vertex that has no normal; zero for all others.
std::vector<glm::dvec3> substitute_normals(const Mesh& mesh, std::span<const Triangle> triangles) {
    std::vector<glm::dvec3> sums(mesh.normals.size());
    for (const Triangle& triangle : triangles) {
        const glm::dvec3 area = area_vector(mesh, triangle);
        for (uint32_t vertex : triangle) {
            if (mesh.normals[vertex] == glm::vec3(0)) sums[vertex] += area;
        }
    }
    return sums;
}

}  // namespace

void check_mesh(const std::filesystem::path& path, const Mesh& mesh) {
    const size_t vertices = mesh.positions_m.size();
    PATINA_ASSERT(mesh.normals.size() == vertices && mesh.colors.size() == vertices, "positions ", vertices,
                  ", normals ", mesh.normals.size(), ", colors ", mesh.colors.size());
    check_finite(path, "position", mesh.positions_m);
    check_finite(path, "normal", mesh.normals);
    check_finite(path, "colour", mesh.colors);
    for (const Triangle& triangle : mesh.triangles) {
        const uint32_t largest = std::ranges::max(triangle);
        if (largest >= vertices) throw Error(path, ": a triangle names vertex ", largest, " of ", vertices);
    }
}

void check_reflectance(const std::filesystem::path& path, const Mesh& mesh, const MeshReflectance& reflectance) {
    const auto& [kd, labels, segments] = reflectance;
    PATINA_ASSERT(kd.size() == labels.size() && kd.size() == mesh.positions_m.size(), "vertices ",
                  mesh.positions_m.size(), ", kd ", kd.size(), ", labels ", labels.size());
    check_finite(path, "albedo", std::vector<glm::vec3>(kd.begin(), kd.end()));
}

std::vector<Triangle> drawable_triangles(const Mesh& mesh) {
    std::vector<Triangle> kept;
    kept.reserve(mesh.triangles.size());
    std::ranges::copy_if(mesh.triangles, std::back_inserter(kept),
                         [&](const Triangle& t) { return area_vector(mesh, t) != glm::dvec3(0); });
    return kept;
}

std::vector<glm::vec3> unit_normals(const Mesh& mesh, std::span<const Triangle> triangles) {
    std::vector<glm::vec3> normals(mesh.normals.size());
    std::vector<glm::dvec3> substitutes;
    for (size_t i = 0; i < normals.size(); ++i) {
        glm::dvec3 normal(mesh.normals[i]);
        if (normal == glm::dvec3(0)) {
            if (substitutes.empty()) substitutes = substitute_normals(mesh, triangles);
            normal = substitutes[i];
        }
        // A vertex of no triangle is never drawn; the format still wants a direction there.
        normals[i] = normal == glm::dvec3(0) ? glm::vec3(0, 0, 1) : glm::vec3(glm::normalize(normal));
    }
    return normals;
}

}  // namespace patina
