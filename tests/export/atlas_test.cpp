// A surface is divided into charts, and these are laid out in pages.

#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "export/atlas/find_charts.h"
#include "export/atlas/lay_out_texture.h"
#include "export/atlas/pack_boxes.h"
#include "tests/export/test_meshes.h"

namespace patina::atlas_test {
namespace {

using test::wavy_sheet;

/// A ball of `rings` x 2 rings quads, without its poles' caps.
Mesh ball(uint32_t rings) {
    Mesh mesh;
    const uint32_t around = 2 * rings;
    for (uint32_t i = 0; i <= rings; ++i) {
        const double polar = std::numbers::pi * (0.05 + 0.9 * i / rings);
        for (uint32_t k = 0; k < around; ++k) {
            const double turn = 2 * std::numbers::pi * k / around;
            const glm::dvec3 n(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar));
            mesh.positions_m.emplace_back(0.5 * n);
            mesh.normals.emplace_back(n);
            mesh.colors.emplace_back(0.5f);
        }
    }
    for (uint32_t i = 0; i < rings; ++i) {
        for (uint32_t k = 0; k < around; ++k) {
            const uint32_t a = i * around + k, b = i * around + (k + 1) % around;
            mesh.triangles.push_back({a, a + around, b});
            mesh.triangles.push_back({b, a + around, b + around});
        }
    }
    return mesh;
}

std::array<glm::dvec2, 3> projected(const Mesh& mesh, const Chart& chart, uint32_t triangle) {
    std::array<glm::dvec2, 3> corners;
    for (size_t i = 0; i < 3; ++i) {
        const glm::vec3 position = mesh.positions_m[mesh.triangles[triangle][i]];
        corners[i] = {glm::dot(position, chart.right), glm::dot(position, chart.down)};
    }
    return corners;
}

double twice_area(const std::array<glm::dvec2, 3>& c) {
    const glm::dvec2 a = c[1] - c[0], b = c[2] - c[0];
    return a.x * b.y - a.y * b.x;
}

bool contains(const std::array<glm::dvec2, 3>& c, glm::dvec2 p) {
    const double whole = twice_area(c);
    for (size_t i = 0; i < 3; ++i)
        if (twice_area({c[i], c[(i + 1) % 3], p}) / whole < 0) return false;
    return true;
}

/// Each triangle lies in one chart, faces the way its plane does, and is covered by no other of its chart.
void expect_charts_are_flat(const Mesh& mesh, const std::vector<Chart>& charts) {
    std::set<uint32_t> seen;
    for (const Chart& chart : charts) {
        EXPECT_NEAR(glm::dot(chart.right, chart.down), 0, 1e-5);
        for (const uint32_t t : chart.triangles) {
            EXPECT_TRUE(seen.insert(t).second) << "triangle " << t << " lies in two charts";
            const auto corners = projected(mesh, chart, t);
            // Right times down points into the surface, so that counter-clockwise triangles turn clockwise in a
            // picture.
            EXPECT_LT(twice_area(corners), 0);
            const glm::dvec2 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
            for (const uint32_t other : chart.triangles) {
                const bool covered = other != t && contains(projected(mesh, chart, other), middle);
                EXPECT_FALSE(covered) << t << " under " << other;
            }
            for (const glm::dvec2 corner : corners) {
                const glm::dvec2 in = corner - glm::dvec2(chart.low_m);
                EXPECT_TRUE(in.x > -1e-5 && in.y > -1e-5 && in.x < chart.size_m.x + 1e-5 &&
                            in.y < chart.size_m.y + 1e-5);
            }
        }
    }
    EXPECT_EQ(seen.size(), mesh.triangles.size());
}

Mesh flat_sheet(uint32_t width, uint32_t height) {
    Mesh mesh = wavy_sheet(width, height);
    for (glm::vec3& position : mesh.positions_m) position.z = 0;
    std::ranges::fill(mesh.normals, glm::vec3(0, 0, 1));
    return mesh;
}

TEST(FindCharts, AFlatSheetIsOneChartOfItsSize) {
    const Mesh sheet = flat_sheet(31, 21);  // 30 x 20 cm
    const std::vector<Chart> charts = find_charts(sheet, 8);
    ASSERT_EQ(charts.size(), 1u);
    expect_charts_are_flat(sheet, charts);
    EXPECT_NEAR(std::max(charts[0].size_m.x, charts[0].size_m.y), 0.3, 1e-5);
    EXPECT_NEAR(std::min(charts[0].size_m.x, charts[0].size_m.y), 0.2, 1e-5);
}

TEST(FindCharts, ABoxLiesAlongTheAxesHoweverTheSheetIsTurned) {
    Mesh sheet = flat_sheet(31, 21);
    const float angle = 0.7f;
    for (glm::vec3& p : sheet.positions_m)
        p = {std::cos(angle) * p.x - std::sin(angle) * p.y, std::sin(angle) * p.x + std::cos(angle) * p.y, 0};
    const std::vector<Chart> charts = find_charts(sheet, 8);
    ASSERT_EQ(charts.size(), 1u);
    // Every fifth degree is tried: half a step wastes 30 sin(2.5 degrees) of 20 cm.
    EXPECT_LT(charts[0].size_m.x * charts[0].size_m.y, 0.06 * 1.12);
}

TEST(FindCharts, ABallTakesAFewFlatOnes) {
    const Mesh sphere = ball(24);
    const std::vector<Chart> charts = find_charts(sphere, 8);
    EXPECT_GE(charts.size(), 5u);
    EXPECT_LE(charts.size(), 30u);
    expect_charts_are_flat(sphere, charts);
}

TEST(FindCharts, ARoofOverItselfIsTwoCharts) {
    // A ramp that turns once about an axis and rises by 20 cm: what hangs together lies over itself.
    Mesh ramp;
    const uint32_t steps = 80;
    for (uint32_t i = 0; i <= steps; ++i) {
        const double turn = 3 * std::numbers::pi * i / steps;
        for (const double radius : {0.3, 0.5}) {
            ramp.positions_m.emplace_back(radius * std::cos(turn), radius * std::sin(turn), 0.2 * i / steps);
            ramp.normals.emplace_back(0, 0, 1);
            ramp.colors.emplace_back(0.5f);
        }
    }
    for (uint32_t i = 0; i < steps; ++i) {
        ramp.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 2});
        ramp.triangles.push_back({2 * i + 1, 2 * i + 3, 2 * i + 2});
    }
    const std::vector<Chart> charts = find_charts(ramp, 8);
    EXPECT_GE(charts.size(), 2u);
    expect_charts_are_flat(ramp, charts);
}

TEST(FindCharts, NoneIsLargerThanAsked) {
    const Mesh sheet = wavy_sheet(60, 40);
    const std::vector<Chart> charts = find_charts(sheet, 0.15);
    EXPECT_GE(charts.size(), 12u);
    for (const Chart& chart : charts) EXPECT_LE(std::max(chart.size_m.x, chart.size_m.y), 0.15 + 1e-5);
    expect_charts_are_flat(sheet, charts);
}

TEST(FindCharts, TrianglesWithoutAreaAreLeftOut) {
    Mesh sheet = flat_sheet(3, 3);
    sheet.triangles.push_back({0, 0, 1});
    size_t triangles = 0;
    for (const Chart& chart : find_charts(sheet, 8)) triangles += chart.triangles.size();
    EXPECT_EQ(triangles, 8u);
}

TEST(PackBoxes, NoTwoOverlapAndOnePageIsSmall) {
    std::vector<glm::uvec2> boxes;
    for (uint32_t i = 0; i < 200; ++i) boxes.emplace_back(5 + i * 7 % 40, 3 + i * 11 % 30);
    const PackedBoxes packed = pack_boxes(boxes, 4096);
    ASSERT_EQ(packed.pages.size(), 1u);
    std::set<std::pair<uint32_t, uint32_t>> taken;
    uint64_t area = 0;
    for (size_t i = 0; i < boxes.size(); ++i) {
        const glm::uvec2 at = packed.places[i].at;
        EXPECT_LE(at.x + boxes[i].x, packed.pages[0].width);
        EXPECT_LE(at.y + boxes[i].y, packed.pages[0].height);
        for (uint32_t y = 0; y < boxes[i].y; ++y)
            for (uint32_t x = 0; x < boxes[i].x; ++x) ASSERT_TRUE(taken.emplace(at.x + x, at.y + y).second);
        area += uint64_t{boxes[i].x} * boxes[i].y;
    }
    EXPECT_LT(packed.pages[0].area(), 1.35 * static_cast<double>(area));
}

TEST(PackBoxes, WhatDoesNotFitGoesToMorePages) {
    const std::vector<glm::uvec2> boxes(5, glm::uvec2(60, 60));
    const PackedBoxes packed = pack_boxes(boxes, 64);
    EXPECT_EQ(packed.pages.size(), 5u);
    std::set<uint32_t> pages;
    for (const PackedBoxes::Place& place : packed.places) pages.insert(place.page);
    EXPECT_EQ(pages.size(), 5u);
}

TidyPiece piece_of(const Mesh& mesh, uint32_t width) {
    TidyPiece piece{mesh, {}, 0, 0};
    piece.reflectance.segments.resize(3);
    for (uint32_t i = 0; i < mesh.positions_m.size(); ++i) {
        piece.reflectance.kd.emplace_back(0.3f, 0.3f, 0.3f, 1.0f);
        piece.reflectance.labels.push_back(i % width < width / 2 ? 1u : 2u);
    }
    return piece;
}

TEST(LayOutTexture, TexelsAreSquareAndSegmentsApart) {
    const TextureLayout layout = lay_out_texture({piece_of(flat_sheet(41, 31), 41)}, {.texel_m = 0.005});
    EXPECT_EQ(layout.texel_m, 0.005);
    ASSERT_EQ(layout.pages.size(), 1u);
    ASSERT_EQ(layout.pieces.size(), 1u);
    const TexturedSurface& surface = layout.pieces[0];
    EXPECT_EQ(surface.mesh.triangles.size(), 40u * 30 * 2);
    for (const auto& t : surface.mesh.triangles) {
        EXPECT_EQ(surface.reflectance.labels[t[0]], surface.reflectance.labels[t[1]]);
        const double on_surface = double{glm::distance(surface.mesh.positions_m[t[0]], surface.mesh.positions_m[t[1]])};
        const double in_page = double{glm::distance(surface.place_px[t[0]], surface.place_px[t[1]])};
        EXPECT_NEAR(in_page * 0.005, on_surface, 1e-5);
    }
    ASSERT_EQ(layout.boxes.size(), 2u);
    EXPECT_NE(layout.boxes[0].label, layout.boxes[1].label);
    for (size_t i = 0; i < surface.place_px.size(); ++i) {
        const TextureBox& box = layout.boxes[surface.reflectance.labels[i] == layout.boxes[0].label ? 0 : 1];
        const glm::vec2 place = surface.place_px[i], gutter(kTextureGutter);
        EXPECT_TRUE(glm::all(glm::greaterThanEqual(place, glm::vec2(box.low) + gutter)));
        EXPECT_TRUE(glm::all(glm::lessThanEqual(place, glm::vec2(box.high) - gutter)));
    }
}

// As glTF has it: a tangent goes right in the page, and the third axis up.
TEST(LayOutTexture, TangentsFollowThePage) {
    const TextureLayout layout = lay_out_texture({piece_of(flat_sheet(41, 31), 41)}, {.texel_m = 0.005});
    const TexturedSurface& surface = layout.pieces.at(0);
    ASSERT_EQ(surface.tangents.size(), surface.place_px.size());
    for (const auto& t : surface.mesh.triangles) {
        const glm::vec3 tangent(surface.tangents[t[0]]);
        const glm::vec3 up = glm::cross(surface.mesh.normals[t[0]], tangent) * surface.tangents[t[0]].w;
        const glm::vec3 edge = surface.mesh.positions_m[t[1]] - surface.mesh.positions_m[t[0]];
        const glm::vec2 in_page = surface.place_px[t[1]] - surface.place_px[t[0]];
        EXPECT_NEAR(glm::dot(edge, tangent), in_page.x * 0.005f, 1e-5f);
        EXPECT_NEAR(glm::dot(edge, up), -in_page.y * 0.005f, 1e-5f);
    }
}

TEST(LayOutTexture, TexelsGrowWherePagesDoNotSuffice) {
    const Mesh sheet = flat_sheet(101, 101);  // 1 m2, four million texels of 0.5 mm
    const TextureLayout layout =
        lay_out_texture({piece_of(sheet, 101)}, {.texel_m = 0.0005, .most_pages = 2, .page = 512});
    EXPECT_LE(layout.pages.size(), 2u);
    EXPECT_GT(layout.texel_m, 0.0013);
    EXPECT_LT(layout.texel_m, 0.003);
}

TEST(LayOutTexture, ATriangleLargerThanAPageMakesTexelsLarger) {
    Mesh wall;
    for (const glm::vec3 corner : {glm::vec3(0, 0, 0), glm::vec3(3, 0, 0), glm::vec3(0, 3, 0), glm::vec3(3, 3, 0)}) {
        wall.positions_m.push_back(corner);
        wall.normals.emplace_back(0, 0, 1);
        wall.colors.emplace_back(0.5f);
    }
    wall.triangles = {{0, 1, 2}, {1, 3, 2}};
    EXPECT_EQ(find_charts(wall, 0.5).size(), 2u) << "each is larger than asked, and a chart of its own";
    const TextureLayout layout = lay_out_texture({TidyPiece{wall, {}, 0, 0}}, {.texel_m = 0.0005, .page = 512});
    EXPECT_EQ(layout.pieces[0].mesh.triangles.size(), 2u);
    EXPECT_GT(layout.texel_m, 3.0 * std::sqrt(2.0) / 512);
}

TEST(LayOutTexture, ASurfaceWithoutReflectanceHasNoLabels) {
    const TextureLayout layout = lay_out_texture({TidyPiece{flat_sheet(5, 5), {}, 0, 0}, TidyPiece{}}, {});
    ASSERT_EQ(layout.pieces.size(), 2u);
    EXPECT_TRUE(layout.pieces[0].reflectance.labels.empty());
    EXPECT_EQ(layout.pieces[0].mesh.colors.size(), layout.pieces[0].place_px.size());
    EXPECT_TRUE(layout.pieces[1].place_px.empty());
}

}  // namespace
}  // namespace patina::atlas_test
