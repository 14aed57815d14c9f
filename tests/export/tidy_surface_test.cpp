#include "export/tidy_surface.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "tests/export/test_meshes.h"

namespace patina::tidy_surface_test {
namespace {

using test::wavy_sheet;

/// A flat grid of width x height vertices, 1 cm apart, of one colour.
Mesh flat_sheet(uint32_t width, uint32_t height, glm::vec3 corner_m = glm::vec3(0)) {
    Mesh mesh = wavy_sheet(width, height);
    for (glm::vec3& position : mesh.positions_m) position = corner_m + glm::vec3(position.x, position.y, 0);
    std::ranges::fill(mesh.normals, glm::vec3(0, 0, 1));
    std::ranges::fill(mesh.colors, glm::vec3(0.4f));
    return mesh;
}

void add(Mesh& mesh, const Mesh& other) {
    const auto first = static_cast<uint32_t>(mesh.positions_m.size());
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    append(mesh.positions_m, other.positions_m);
    append(mesh.normals, other.normals);
    append(mesh.colors, other.colors);
    for (const auto& t : other.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

double area_m2(const Mesh& mesh) {
    double area = 0;
    for (const auto& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions_m[t[0]]), b(mesh.positions_m[t[1]]), c(mesh.positions_m[t[2]]);
        area += 0.5 * glm::length(glm::cross(b - a, c - a));
    }
    return area;
}

/// Two segments of one albedo: label 1 left of `border` (a column, by row) and label 2 right of it.
MeshReflectance two_segments(const Mesh& sheet, uint32_t width, const std::function<uint32_t(uint32_t)>& border) {
    MeshReflectance reflectance;
    reflectance.segments.resize(3);
    for (uint32_t i = 0; i < sheet.positions_m.size(); ++i) {
        reflectance.kd.emplace_back(0.3f, 0.3f, 0.3f, 1.0f);
        reflectance.labels.push_back(i % width < border(i / width) ? 1u : 2u);
    }
    return reflectance;
}

TEST(TidySurface, AFlatSheetKeepsItsBorderAndItsArea) {
    const Mesh sheet = flat_sheet(50, 40);
    const TidyPiece piece = tidied(sheet, {}, {});
    EXPECT_LT(piece.mesh.triangles.size(), 400u) << "of 3822";
    EXPECT_EQ(piece.mesh.triangles.size() + piece.collapsed_triangles, sheet.triangles.size());
    EXPECT_EQ(piece.loose_triangles, 0u);
    EXPECT_NEAR(area_m2(piece.mesh), area_m2(sheet), 1e-6);
}

TEST(TidySurface, TheSurfaceStaysWithinTheError) {
    const Mesh sheet = wavy_sheet(80, 60);
    for (const double error_m : {0.0005, 0.005}) {
        TidyOptions options;
        options.error_m = error_m;
        Mesh plain = sheet;
        std::ranges::fill(plain.colors, glm::vec3(0.4f));
        const TidyPiece piece = tidied(plain, {}, options);
        EXPECT_LT(piece.mesh.triangles.size(), sheet.triangles.size() / 2);
        // Middles of edges lie farthest from what they stand for: z = 0.1 sin 7x.
        for (const auto& t : piece.mesh.triangles) {
            for (size_t i = 0; i < 3; ++i) {
                const glm::vec3 m = 0.5f * (piece.mesh.positions_m[t[i]] + piece.mesh.positions_m[t[(i + 1) % 3]]);
                EXPECT_NEAR(m.z, 0.1f * std::sin(7 * m.x), 4 * error_m);
            }
        }
    }
}

TEST(TidySurface, PatternsStay) {
    Mesh sheet = flat_sheet(64, 64);
    for (size_t i = 0; i < sheet.colors.size(); ++i) {
        const size_t x = i % 64 / 16, y = i / 64 / 16;
        sheet.colors[i] = glm::vec3((x + y) % 2 == 0 ? 0.1f : 0.8f);
    }
    const TidyPiece piece = tidied(sheet, {}, {});
    const size_t plain = tidied(flat_sheet(64, 64), {}, {}).mesh.triangles.size();
    EXPECT_GT(piece.mesh.triangles.size(), plain);
    // The middle of every triangle that lies wholly in one field has its brightness.
    for (const auto& t : piece.mesh.triangles) {
        const glm::vec3 a = piece.mesh.positions_m[t[0]], b = piece.mesh.positions_m[t[1]],
                        c = piece.mesh.positions_m[t[2]];
        const glm::vec3 middle = (a + b + c) / 3.0f;
        const auto x = static_cast<size_t>(middle.x * 100 + 0.5f), y = static_cast<size_t>(middle.y * 100 + 0.5f);
        if (x % 16 < 2 || x % 16 > 13 || y % 16 < 2 || y % 16 > 13) continue;
        const float shown = (piece.mesh.colors[t[0]] + piece.mesh.colors[t[1]] + piece.mesh.colors[t[2]]).r / 3;
        EXPECT_NEAR(shown, (x / 16 + y / 16) % 2 == 0 ? 0.1f : 0.8f, 0.1f);
    }
}

TEST(TidySurface, StrayPartsAreLeftOut) {
    Mesh mesh = flat_sheet(40, 40);
    const size_t large = mesh.triangles.size();
    add(mesh, flat_sheet(3, 3, {0.1f, 0.1f, 0.2f}));
    mesh.positions_m.back().z += 0.001f;  // no plane of a grid ends it
    add(mesh, flat_sheet(20, 20, {0.1f, 0.1f, 0.1f}));
    TidyOptions options;
    options.error_m = 0;
    TidyPiece piece = tidied(mesh, {}, options);
    // The stray part reaches the highest z, with one vertex.
    EXPECT_EQ(piece.loose_triangles, 8u);
    EXPECT_EQ(piece.mesh.triangles.size(), large + 2 * 19 * 19);
    options.least_part_m = 0.5;
    piece = tidied(mesh, {}, options);
    EXPECT_EQ(piece.mesh.triangles.size(), large) << "the largest part stays whatever its size";
    options.least_part_m = 0;
    EXPECT_EQ(tidied(mesh, {}, options).loose_triangles, 0u);
}

TEST(TidySurface, WhatAPlaneCutsOffStays) {
    Mesh mesh = flat_sheet(40, 40);
    add(mesh, flat_sheet(3, 3, {-0.02f, 0.1f, 0.2f}));
    // Its vertices of lowest x lie in one plane, beyond which nothing is.
    EXPECT_EQ(tidied(mesh, {}, {}).loose_triangles, 0u);
}

struct Less {
    bool operator()(glm::vec3 a, glm::vec3 b) const { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }
};

TEST(TidySurface, SegmentsMeetWithoutGapsAndKeepTheirLabels) {
    const Mesh sheet = wavy_sheet(60, 40);
    const MeshReflectance reflectance = two_segments(sheet, 60, [](uint32_t row) { return 25 + row % 5; });
    TidyOptions options;
    options.error_m = 0.005;
    const TidyPiece piece = tidied(sheet, reflectance, options);
    ASSERT_EQ(piece.reflectance.labels.size(), piece.mesh.positions_m.size());
    ASSERT_EQ(piece.reflectance.kd.size(), piece.mesh.positions_m.size());
    EXPECT_EQ(piece.reflectance.segments.size(), 3u);
    // Edges of one triangle alone lie on the sheet's rim; every other edge has a triangle on both sides.
    std::map<std::pair<std::tuple<float, float, float>, std::tuple<float, float, float>>, int> sides;
    const auto key = [](glm::vec3 p) { return std::tuple(p.x, p.y, p.z); };
    for (const auto& t : piece.mesh.triangles) {
        EXPECT_EQ(piece.reflectance.labels[t[0]], piece.reflectance.labels[t[1]]);
        EXPECT_EQ(piece.reflectance.labels[t[0]], piece.reflectance.labels[t[2]]);
        for (size_t i = 0; i < 3; ++i) {
            auto a = key(piece.mesh.positions_m[t[i]]), b = key(piece.mesh.positions_m[t[(i + 1) % 3]]);
            if (b < a) std::swap(a, b);
            ++sides[{a, b}];
        }
    }
    for (const auto& [edge, triangles] : sides) {
        const auto& [a, b] = edge;
        const auto on_rim = [](const auto& p) {
            const float x = std::get<0>(p), y = std::get<1>(p);
            return x < 1e-6f || y < 1e-6f || x > 0.59f - 1e-6f || y > 0.39f - 1e-6f;
        };
        EXPECT_TRUE(triangles == 2 || (triangles == 1 && on_rim(a) && on_rim(b))) << std::get<0>(a);
    }
}

TEST(TidySurface, ALimitOfTrianglesIsMetByAllSegmentsAlike) {
    const Mesh sheet = wavy_sheet(200, 200);
    const MeshReflectance reflectance = two_segments(sheet, 200, [](uint32_t) { return 100u; });
    const TidyPiece piece = reduced({sheet, reflectance}, 0.1);
    EXPECT_LT(piece.mesh.triangles.size(), sheet.triangles.size() / 10 + 10);
    EXPECT_GT(piece.mesh.triangles.size(), sheet.triangles.size() / 12);
    EXPECT_EQ(piece.mesh.triangles.size() + piece.collapsed_triangles, sheet.triangles.size());
}

TEST(TidySurface, OfNothingIsNothing) {
    EXPECT_TRUE(tidied({}, {}, {}).mesh.positions_m.empty());
    EXPECT_TRUE(reduced({}, 0.5).mesh.positions_m.empty());
}

}  // namespace
}  // namespace patina::tidy_surface_test
