#include "export/close_holes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include "export/same_positions.h"
#include "export/tidy_surface.h"

namespace patina::close_holes_test {
namespace {

constexpr float kRadius_m = 0.1f;
constexpr float kPi = std::numbers::pi_v<float>;

/// A sphere of rings and sectors, counter-clockwise from outside, without the triangles whose middle `is_open`.
Mesh sphere(uint32_t rings, uint32_t sectors, const std::function<bool(glm::vec3)>& is_open) {
    Mesh mesh;
    const auto add_vertex = [&](float polar, float azimuth) {
        const glm::vec3 n(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar));
        mesh.positions_m.push_back(kRadius_m * n);
        mesh.normals.push_back(n);
        mesh.colors.emplace_back(0.5f);
    };
    add_vertex(0, 0);
    for (uint32_t r = 1; r < rings; ++r)
        for (uint32_t s = 0; s < sectors; ++s)
            add_vertex(kPi * static_cast<float>(r) / static_cast<float>(rings),
                       2 * kPi * static_cast<float>(s) / static_cast<float>(sectors));
    add_vertex(kPi, 0);
    const auto at = [&](uint32_t r, uint32_t s) { return 1 + (r - 1) * sectors + s % sectors; };
    const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
        const auto& p = mesh.positions_m;
        if (!is_open((p[a] + p[b] + p[c]) / (3 * kRadius_m))) mesh.triangles.push_back({a, b, c});
    };
    const auto last = static_cast<uint32_t>(mesh.positions_m.size()) - 1;
    for (uint32_t s = 0; s < sectors; ++s) {
        add(0, at(1, s), at(1, s + 1));
        add(last, at(rings - 1, s + 1), at(rings - 1, s));
        for (uint32_t r = 1; r + 1 < rings; ++r) {
            add(at(r, s), at(r + 1, s), at(r + 1, s + 1));
            add(at(r, s), at(r + 1, s + 1), at(r, s + 1));
        }
    }
    return mesh;
}

/// Edges between positions.
struct Edges {
    size_t open = 0;      ///< with one triangle
    size_t turned = 0;    ///< whose two triangles go round different ways
    size_t manifold = 0;  ///< with two that fit
    size_t crowded = 0;   ///< with more
};

Edges edges_of(const Mesh& mesh, const HoleFilling& filling = {}) {
    const std::vector<uint32_t> first = first_of_position(mesh.positions_m);
    std::map<std::pair<uint32_t, uint32_t>, std::pair<int, int>> uses;
    const auto count = [&](uint32_t a, uint32_t b) {
        a = first[a];
        b = first[b];
        auto& [forth, back] = uses[std::minmax(a, b)];
        ++(a < b ? forth : back);
    };
    for (const auto& t : mesh.triangles)
        for (size_t i = 0; i < 3; ++i) count(t[i], t[(i + 1) % 3]);
    for (const auto& t : filling.triangles)
        for (size_t i = 0; i < 3; ++i) count(filling.vertices[t[i]], filling.vertices[t[(i + 1) % 3]]);
    Edges edges;
    for (const auto& [edge, use] : uses) {
        const auto [forth, back] = use;
        edges.open += forth + back == 1;
        edges.crowded += forth + back > 2;
        edges.manifold += forth == 1 && back == 1;
        edges.turned += forth + back == 2 && forth != back;
    }
    return edges;
}

bool near(glm::vec3 direction, glm::vec3 middle, float degrees) {
    return glm::dot(glm::normalize(direction), glm::normalize(middle)) > std::cos(glm::radians(degrees));
}

constexpr HoleOptions kWhole{.most_m = 0.05, .in_pieces = false};

TEST(CloseHoles, ASphereWithAHoleIsClosed) {
    const Mesh mesh = sphere(40, 80, [](glm::vec3 p) { return near(p, {1, 0.3f, 0.2f}, 8); });
    ASSERT_GT(edges_of(mesh).open, 12u);
    const HoleFilling filling = close_holes(mesh, kWhole);
    EXPECT_EQ(filling.holes, 1u);
    const Edges edges = edges_of(mesh, filling);
    EXPECT_EQ(edges.open, 0u);
    EXPECT_EQ(edges.turned, 0u);
    EXPECT_EQ(edges.crowded, 0u);
    for (const auto& t : filling.triangles) {
        const auto at = [&](size_t i) { return mesh.positions_m[filling.vertices[t[i]]]; };
        EXPECT_GT(glm::dot(glm::cross(at(1) - at(0), at(2) - at(0)), glm::vec3(1, 0.3f, 0.2f)), 0) << "faces outwards";
    }
}

/// A flat hole is closed by its own area, whatever its shape.
TEST(CloseHoles, ABentHoleInAPlaneIsClosedFlat) {
    Mesh mesh;
    constexpr uint32_t kWidth = 20;
    for (uint32_t y = 0; y < kWidth; ++y) {
        for (uint32_t x = 0; x < kWidth; ++x) {
            mesh.positions_m.emplace_back(0.005f * static_cast<float>(x), 0.005f * static_cast<float>(y), 0);
            mesh.normals.emplace_back(0, 0, 1);
            mesh.colors.emplace_back(0.5f);
        }
    }
    double missing_m2 = 0;
    for (uint32_t y = 0; y + 1 < kWidth; ++y) {
        for (uint32_t x = 0; x + 1 < kWidth; ++x) {
            const bool in_l = (x >= 5 && x < 7 && y >= 5 && y < 11) || (x >= 5 && x < 11 && y >= 9 && y < 11);
            missing_m2 += in_l ? 0.005 * 0.005 : 0;
            const uint32_t i = y * kWidth + x;
            if (in_l) continue;
            mesh.triangles.push_back({i, i + 1, i + kWidth});
            mesh.triangles.push_back({i + 1, i + kWidth + 1, i + kWidth});
        }
    }
    const HoleFilling filling = close_holes(mesh, kWhole);
    EXPECT_EQ(filling.holes, 1u) << "the border of the plane itself is none";
    double area_m2 = 0;
    for (const auto& t : filling.triangles) {
        const auto at = [&](size_t i) { return mesh.positions_m[filling.vertices[t[i]]]; };
        const double own_m2 = 0.5 * glm::length(glm::cross(at(1) - at(0), at(2) - at(0)));
        EXPECT_GT(own_m2, 1e-7);
        area_m2 += own_m2;
    }
    EXPECT_NEAR(area_m2, missing_m2, 1e-8);
    EXPECT_EQ(edges_of(mesh, filling).open, 4 * (kWidth - 1));
}

/// Even where it is no larger than a hole may be.
TEST(CloseHoles, TheBorderOfASmallPlaneStaysOpen) {
    Mesh patch;
    patch.positions_m = {{0, 0, 0}, {0.02f, 0, 0}, {0.02f, 0.02f, 0}, {0, 0.02f, 0}};
    patch.normals.assign(4, {0, 0, 1});
    patch.colors.assign(4, glm::vec3(0.5f));
    patch.triangles = {{0, 1, 2}, {0, 2, 3}};
    EXPECT_EQ(close_holes(patch, kWhole).holes, 0u);
}

TEST(CloseHoles, LargerHolesStayOpen) {
    const auto holes_of = [](float degrees) {
        return close_holes(sphere(40, 80, [=](glm::vec3 p) { return near(p, {1, 0, 0}, degrees); }), kWhole).holes;
    };
    EXPECT_EQ(holes_of(8), 1u);
    EXPECT_EQ(holes_of(25), 0u) << "8 cm wide";
}

TEST(CloseHoles, HolesThatMeetInAVertexAreTwo) {
    const Mesh mesh = sphere(16, 16, [](glm::vec3) { return false; });
    Mesh open = mesh;
    open.triangles.clear();
    // Two triangles opposite each other in one vertex.
    const uint32_t meeting = 1 + 7 * 16 + 3;
    std::vector<size_t> around;
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
        if (std::ranges::count(mesh.triangles[i], meeting) > 0) around.push_back(i);
    ASSERT_EQ(around.size(), 6u);
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const glm::vec3 middle = (mesh.positions_m[mesh.triangles[i][0]] + mesh.positions_m[mesh.triangles[i][1]] +
                                  mesh.positions_m[mesh.triangles[i][2]]) /
                                 3.0f;
        const bool around_it = std::ranges::count(around, i) > 0;
        const float z = middle.z - mesh.positions_m[meeting].z;
        const bool is_end = around_it && std::abs(z) > 0.011f;  // the outermost up and down
        if (!is_end) open.triangles.push_back(mesh.triangles[i]);
    }
    ASSERT_LT(open.triangles.size(), mesh.triangles.size());
    const HoleFilling filling = close_holes(open, {.most_m = 1, .in_pieces = false});
    EXPECT_EQ(filling.holes, 2u);
    const Edges edges = edges_of(open, filling);
    EXPECT_EQ(edges.open + edges.turned + edges.crowded, 0u);
}

/// A piece of a surface ends where the next begins.
TEST(CloseHoles, WhatAPiecesEndCutsIsNoHole) {
    constexpr uint32_t kRing = 1 + 80;  // the first vertex of the second ring, 3 cm wide
    Mesh cut = sphere(40, 80, [](glm::vec3 p) { return near(p, {0, 0, 1}, 8); });
    for (uint32_t above = 0; above < kRing; ++above) cut.positions_m[above] = cut.positions_m[kRing];
    EXPECT_EQ(close_holes(cut, {.most_m = 0.05, .in_pieces = true}).holes, 0u);
    EXPECT_EQ(close_holes(cut, {.most_m = 0.05, .in_pieces = false}).holes, 1u);
}

TEST(CloseHoles, NothingIsClosedWhereNothingIsAskedFor) {
    const Mesh mesh = sphere(40, 80, [](glm::vec3 p) { return near(p, {1, 0.3f, 0.2f}, 8); });
    EXPECT_EQ(close_holes(mesh, {.most_m = 0, .in_pieces = false}).triangles.size(), 0u);
    EXPECT_EQ(close_holes({}, kWhole).holes, 0u);
}

/// Collapsing leaves no gap between what was measured and what was filled, nor between segments.
TEST(CloseHoles, ATidiedSphereIsClosedAndSaysWhere) {
    const Mesh mesh = sphere(60, 120, [](glm::vec3 p) { return near(p, {1, 0.3f, 0.2f}, 8); });
    MeshReflectance reflectance;
    reflectance.segments.resize(3);
    for (const glm::vec3& position : mesh.positions_m) {
        reflectance.kd.emplace_back(0.3f, 0.3f, 0.3f, 1.0f);
        reflectance.labels.push_back(position.y > 0.03f ? 1 : 2);  // the border between them crosses the hole
    }
    TidyOptions options;
    options.in_pieces = false;
    const TidyPiece piece = tidied(mesh, reflectance, options);
    EXPECT_EQ(piece.closed_holes, 1u);
    ASSERT_EQ(piece.filled.size(), piece.mesh.positions_m.size());
    size_t filled = 0;
    for (const auto& t : piece.mesh.triangles) {
        EXPECT_EQ(piece.filled[t[0]], piece.filled[t[1]]);
        EXPECT_EQ(piece.filled[t[0]], piece.filled[t[2]]);
        EXPECT_EQ(piece.reflectance.labels[t[0]], piece.reflectance.labels[t[1]]);
        const glm::vec3 middle =
            (piece.mesh.positions_m[t[0]] + piece.mesh.positions_m[t[1]] + piece.mesh.positions_m[t[2]]) / 3.0f;
        EXPECT_TRUE(piece.filled[t[0]] == 0 || near(middle, {1, 0.3f, 0.2f}, 10));
        filled += piece.filled[t[0]];
    }
    EXPECT_GT(filled, 0u);
    const Edges edges = edges_of(piece.mesh);
    EXPECT_EQ(edges.open + edges.turned + edges.crowded, 0u);
}

}  // namespace
}  // namespace patina::close_holes_test
