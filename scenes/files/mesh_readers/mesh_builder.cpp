#include "scenes/files/mesh_readers/mesh_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/input_file.h"

namespace patina::scenes {
namespace {

/// Splitting a face that is not convex takes up to the cube of its corners in steps.
constexpr size_t kMostConcaveCorners = 256;

using Corners = std::vector<glm::dvec2>;

/// Twice the area of the triangle a, b, c; positive where it turns left.
double turn(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    const glm::dvec2 ab = b - a, ac = c - a;
    return ab.x * ac.y - ab.y * ac.x;
}

/// The face seen along the axis that it faces most, so that it turns left as a whole.
Corners flattened(std::span<const MeshCorner> corners) {
    glm::dvec3 normal(0);  // Newell's: the sum over all edges, which is right for faces that are not quite flat
    for (size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 origin = corners[0].position;
        normal += glm::cross(corners[i].position - origin, corners[(i + 1) % corners.size()].position - origin);
    }
    const glm::dvec3 size = glm::abs(normal);
    const int axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (normal[axis] < 0) std::swap(u, v);
    Corners flat;
    for (const MeshCorner& corner : corners) flat.emplace_back(corner.position[u], corner.position[v]);
    return flat;
}

bool is_convex(const Corners& p) {
    for (size_t i = 0; i < p.size(); ++i) {
        if (!(turn(p[i], p[(i + 1) % p.size()], p[(i + 2) % p.size()]) > 0)) return false;
    }
    return true;
}

bool contains(const std::array<glm::dvec2, 3>& triangle, glm::dvec2 p) {
    const auto& [a, b, c] = triangle;
    if (p == a || p == b || p == c) return false;  // another corner at the same place cuts nothing off
    return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

/// Whether the corner at `place` of those that are left can be cut off: it turns left, and no other lies within.
bool is_ear(const Corners& p, const std::vector<uint32_t>& left, size_t place) {
    const size_t n = left.size();
    const std::array triangle{p[left[(place + n - 1) % n]], p[left[place]], p[left[(place + 1) % n]]};
    if (!(turn(triangle[0], triangle[1], triangle[2]) > 0)) return false;
    return std::none_of(left.begin(), left.end(), [&](uint32_t other) { return contains(triangle, p[other]); });
}

void add_fan(const std::vector<uint32_t>& left, std::vector<glm::uvec3>& triangles) {
    for (size_t i = 2; i < left.size(); ++i) triangles.emplace_back(left[0], left[i - 1], left[i]);
}

/// The face's triangles by its corners' indices: a fan where it is convex, else ear after ear. What crosses itself may
/// run out of ears; the rest is a fan then.
std::vector<glm::uvec3> split(std::span<const MeshCorner> corners) {
    std::vector<uint32_t> left(corners.size());
    for (uint32_t i = 0; i < left.size(); ++i) left[i] = i;
    std::vector<glm::uvec3> triangles;
    const Corners flat = left.size() > 3 ? flattened(corners) : Corners();
    if (left.size() > 3 && !is_convex(flat)) {
        if (left.size() > kMostConcaveCorners) {
            throw Error("a face that is not convex has ", left.size(), " corners, at most ", kMostConcaveCorners,
                        " are split");
        }
        for (size_t place = 0; left.size() > 3 && place < left.size();) {
            if (!is_ear(flat, left, place)) {
                ++place;
                continue;
            }
            const size_t n = left.size();
            triangles.emplace_back(left[(place + n - 1) % n], left[place], left[(place + 1) % n]);
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(place));
            place = 0;
        }
    }
    add_fan(left, triangles);
    return triangles;
}

template <class Vector>
void expect_finite(const char* what, const Vector& v) {
    for (int i = 0; i < v.length(); ++i) {
        if (!std::isfinite(static_cast<float>(v[i])))
            throw Error("a vertex has a ", what, " of ", v[i], ", which is no finite float");
    }
}

glm::vec3 face_normal(const TriangleMesh& mesh, size_t first) {
    const glm::dvec3 a(mesh.positions_m[first]), b(mesh.positions_m[first + 1]), c(mesh.positions_m[first + 2]);
    return glm::vec3(glm::normalize(glm::cross(b - a, c - a)));
}

/// Of length 1, or 0 where it has none.
glm::vec3 unit(const std::optional<glm::dvec3>& normal) {
    const double length = normal ? glm::length(*normal) : 0;
    return std::isfinite(length) && length > 1e-12 ? glm::vec3(*normal / length) : glm::vec3(0);
}

}  // namespace

void MeshBuilder::add_corner(const MeshCorner& corner) {
    expect_finite("coordinate", corner.position);
    has_normals_ |= corner.normal.has_value();
    has_uvs_ |= corner.uv.has_value();
    const glm::dvec2 uv = corner.uv.value_or(glm::dvec2(0));
    expect_finite("texture coordinate", uv);
    mesh_.positions_m.emplace_back(corner.position);
    mesh_.normals.push_back(unit(corner.normal));
    mesh_.texture_coordinates.emplace_back(uv);
}

void MeshBuilder::add_face(std::span<const MeshCorner> corners) {
    PATINA_ASSERT(corners.size() >= 3, "corners ", corners.size());
    if (corners.size() - 2 > limits::kTriangles - mesh_.triangles.size())
        throw Error("the mesh has more than ", limits::kTriangles, " triangles, the most that are read");
    for (const glm::uvec3 triangle : split(corners)) {
        const auto first = static_cast<uint32_t>(mesh_.positions_m.size());
        mesh_.triangles.emplace_back(first, first + 1, first + 2);
        for (int i = 0; i < 3; ++i) add_corner(corners[triangle[i]]);
    }
}

TriangleMesh MeshBuilder::finish() && {
    if (!has_uvs_) mesh_.texture_coordinates.clear();
    if (!has_normals_) mesh_.normals.clear();
    for (size_t i = 0; i < mesh_.normals.size(); ++i) {
        if (mesh_.normals[i] == glm::vec3(0)) mesh_.normals[i] = face_normal(mesh_, i - i % 3);
    }
    return std::move(mesh_);
}

}  // namespace patina::scenes
