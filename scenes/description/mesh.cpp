#include "scenes/description/mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "engine/core/error.h"

namespace patina::scenes {
namespace {

/// All floats of one vertex.
struct Vertex {
    glm::vec3 position_m;
    glm::vec3 normal{0};
    glm::vec2 texture_coordinates{0};

    bool operator==(const Vertex&) const = default;
};

/// The bits of floats as a hash; -0 must have been made 0.
template <class Value>
struct BitHash {
    size_t operator()(const Value& value) const {
        return std::hash<std::string_view>()({reinterpret_cast<const char*>(&value), sizeof(Value)});
    }
};

Vertex vertex_of(const TriangleMesh& mesh, uint32_t index) {
    Vertex vertex{mesh.positions_m[index] + 0.0f};  // -0 + 0 is 0
    if (!mesh.normals.empty()) vertex.normal = mesh.normals[index] + 0.0f;
    if (!mesh.texture_coordinates.empty()) vertex.texture_coordinates = mesh.texture_coordinates[index] + 0.0f;
    return vertex;
}

void append(TriangleMesh& mesh, const Vertex& vertex, bool normals, bool texture_coordinates) {
    mesh.positions_m.push_back(vertex.position_m);
    if (normals) mesh.normals.push_back(vertex.normal);
    if (texture_coordinates) mesh.texture_coordinates.push_back(vertex.texture_coordinates);
}

std::array<glm::dvec3, 3> corners(const TriangleMesh& mesh, glm::uvec3 triangle) {
    const auto corner = [&](uint32_t index) { return glm::dvec3(mesh.positions_m[index]); };
    return {corner(triangle.x), corner(triangle.y), corner(triangle.z)};
}

double angle_between(glm::dvec3 a, glm::dvec3 b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

/// Sums of the triangles' normals by position, weighted by their angles there.
std::unordered_map<glm::vec3, glm::dvec3, BitHash<glm::vec3>> summed_normals(const TriangleMesh& mesh) {
    std::unordered_map<glm::vec3, glm::dvec3, BitHash<glm::vec3>> sums;
    for (const glm::uvec3 triangle : mesh.triangles) {
        const std::array<glm::dvec3, 3> p = corners(mesh, triangle);
        const glm::dvec3 normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 here = p[size_t(i)];
            const double angle = angle_between(p[size_t(i + 1) % 3] - here, p[size_t(i + 2) % 3] - here);
            sums.try_emplace(mesh.positions_m[triangle[i]] + 0.0f, 0.0).first->second += angle * normal;
        }
    }
    return sums;
}

std::pair<glm::vec3, glm::vec3> bounds(const TriangleMesh& mesh) {
    glm::vec3 low(INFINITY), high(-INFINITY);
    for (const glm::vec3 p : mesh.positions_m) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    return {low, high};
}

}  // namespace

void check_triangles(const TriangleMesh& mesh) {
    if (mesh.triangles.empty()) throw Error("there are no triangles");
    constexpr double kSliver = 1e-7, kSmallest_m2 = 1e-18;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::array<glm::dvec3, 3> p = corners(mesh, mesh.triangles[i]);
        const double area_m2 = glm::length(glm::cross(p[1] - p[0], p[2] - p[0])) / 2;
        const double longest_m =
            std::max({glm::distance(p[0], p[1]), glm::distance(p[1], p[2]), glm::distance(p[2], p[0])});
        if (std::isfinite(area_m2) && area_m2 >= kSmallest_m2 && 2 * area_m2 >= kSliver * longest_m * longest_m)
            continue;
        throw Error("triangle ", i, " is degenerate: its area is ", area_m2, " m^2, its longest edge ", longest_m,
                    " m");
    }
}

TriangleMesh transformed(TriangleMesh mesh, const glm::dmat3& rotation, double scale) {
    for (glm::vec3& p : mesh.positions_m) p = glm::vec3(scale * (rotation * glm::dvec3(p)));
    for (glm::vec3& n : mesh.normals) n = glm::vec3(rotation * glm::dvec3(n));
    return mesh;
}

TriangleMesh standing(TriangleMesh mesh, double height_m) {
    const auto [low, high] = bounds(mesh);
    const double scale = height_m / (double(high.y) - low.y);
    if (!std::isfinite(scale)) throw Error("the mesh is flat: its lowest and highest point are at y = ", low.y);
    const glm::dvec3 origin((double(low.x) + high.x) / 2, high.y, (double(low.z) + high.z) / 2);
    for (glm::vec3& p : mesh.positions_m) p = glm::vec3(scale * (glm::dvec3(p) - origin));
    return mesh;
}

TriangleMesh with_smooth_normals(TriangleMesh mesh) {
    const auto sums = summed_normals(mesh);
    mesh.normals.assign(mesh.positions_m.size(), glm::vec3(0));
    for (const glm::uvec3 triangle : mesh.triangles) {
        const std::array<glm::dvec3, 3> p = corners(mesh, triangle);
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 sum = sums.at(mesh.positions_m[triangle[i]] + 0.0f);
            const bool cancelled = glm::length(sum) < 1e-6;
            mesh.normals[triangle[i]] =
                glm::vec3(glm::normalize(cancelled ? glm::cross(p[1] - p[0], p[2] - p[0]) : sum));
        }
    }
    return mesh;
}

TriangleMesh joined(const TriangleMesh& mesh) {
    TriangleMesh out;
    std::unordered_map<Vertex, uint32_t, BitHash<Vertex>> index_of;
    const auto joined_index = [&](uint32_t index) {
        const Vertex vertex = vertex_of(mesh, index);
        const auto [entry, is_new] = index_of.try_emplace(vertex, static_cast<uint32_t>(out.positions_m.size()));
        if (is_new) append(out, vertex, !mesh.normals.empty(), !mesh.texture_coordinates.empty());
        return entry->second;
    };
    for (const glm::uvec3 t : mesh.triangles) {
        const uint32_t a = joined_index(t.x), b = joined_index(t.y), c = joined_index(t.z);  // in this order
        out.triangles.emplace_back(a, b, c);
    }
    return out;
}

}  // namespace patina::scenes
