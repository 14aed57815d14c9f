#include "reconstruction/texture/split_triangles.h"

#include <array>

#include <gtest/gtest.h>

namespace patina::split_triangles_test {
namespace {

/// A triangle of a plane that leans, with what each vertex has; edges of 0.3, 0.4 and 0.5 m.
TexturedSurface triangle() {
    TexturedSurface surface;
    surface.mesh.positions_m = {{1, 2, 3}, {1.3f, 2, 3}, {1, 2, 3.4f}};
    surface.mesh.normals = {{0, -1, 0}, {0, -1, 0}, {0.6f, -0.8f, 0}};
    surface.mesh.colors = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    surface.mesh.triangles = {{0, 1, 2}};
    surface.reflectance.kd = {glm::vec4(0.5f), glm::vec4(0.25f), glm::vec4(0.75f)};
    surface.reflectance.labels = {3, 3, 3};
    surface.place_px = {{10, 20}, {40, 20}, {10, 60}};
    surface.pages = {2, 2, 2};
    return surface;
}

float area(glm::vec3 a, glm::vec3 b, glm::vec3 c) { return 0.5f * glm::length(glm::cross(b - a, c - a)); }

TEST(WithShortEdges, CoversTheSameSurfaceOnceWithShortEdges) {
    const TexturedSurface split = with_short_edges(triangle(), 0.1);
    EXPECT_LT(split.mesh.triangles.size(), 32u);
    float sum = 0;
    for (const auto& corners : split.mesh.triangles) {
        std::array<glm::vec3, 3> at{};
        for (size_t i = 0; i < 3; ++i) at[i] = split.mesh.positions_m[corners[i]];
        for (size_t i = 0; i < 3; ++i) EXPECT_LE(glm::distance(at[i], at[(i + 1) % 3]), 0.2f);
        EXPECT_LT(glm::cross(at[1] - at[0], at[2] - at[0]).y, 0.0f) << "turned as the whole one";
        sum += area(at[0], at[1], at[2]);
    }
    EXPECT_NEAR(sum, 0.06f, 1e-5f);
}

TEST(WithShortEdges, WhatVerticesHaveIsInterpolated) {
    const TexturedSurface whole = triangle(), split = with_short_edges(whole, 0.1);
    const size_t count = split.mesh.positions_m.size();
    ASSERT_EQ(split.mesh.normals.size(), count);
    ASSERT_EQ(split.mesh.colors.size(), count);
    ASSERT_EQ(split.place_px.size(), count);
    ASSERT_EQ(split.pages.size(), count);
    ASSERT_EQ(split.reflectance.kd.size(), count);
    ASSERT_EQ(split.reflectance.labels.size(), count);
    for (const auto& corners : split.mesh.triangles) {
        for (const uint32_t i : corners) {
            const glm::vec2 at =
                (split.place_px[i] - glm::vec2(10, 20)) / glm::vec2(30, 40);  // shares of the two others
            const glm::vec3 shares(1 - at.x - at.y, at.x, at.y);
            EXPECT_LT(glm::distance(split.mesh.positions_m[i], glm::vec3(1 + 0.3f * at.x, 2, 3 + 0.4f * at.y)), 1e-5f);
            EXPECT_LT(glm::distance(split.mesh.colors[i], shares), 1e-5f);
            EXPECT_NEAR(glm::length(split.mesh.normals[i]), 1, 1e-5f);
            EXPECT_EQ(split.pages[i], 2u);
            EXPECT_EQ(split.reflectance.labels[i], 3u);
        }
    }
}

TEST(WithShortEdges, NarrowTrianglesAreSplitAlongTheirLengthAlone) {
    TexturedSurface sliver = triangle();
    sliver.mesh.positions_m = {{0, 0, 0}, {4, 0, 0}, {0, 0, 0.005f}};
    EXPECT_LT(with_short_edges(sliver, 0.02).mesh.triangles.size(), 1000u) << "200 parts of its length";
}

TEST(WithShortEdges, WhatOneCornerDoesNotKnowIsNotKnownBetween) {
    TexturedSurface whole = triangle();
    whole.reflectance.kd[2] = glm::vec4(0);
    for (const TexturedSurface& surface : {whole, triangle()}) {
        const TexturedSurface split = with_short_edges(surface, 0.1);
        EXPECT_EQ(split.reflectance.kd.back().a > 0, surface.reflectance.kd[2].a > 0);
    }
}

TEST(WithShortEdges, SmallTrianglesAndSurfacesOfColoursAloneStayAsTheyAre) {
    TexturedSurface whole = triangle();
    whole.reflectance = {};
    const TexturedSurface same = with_short_edges(whole, 0.5);
    EXPECT_EQ(same.mesh.triangles, whole.mesh.triangles);
    EXPECT_EQ(same.mesh.positions_m, whole.mesh.positions_m);
    EXPECT_TRUE(with_short_edges(whole, 0.1).reflectance.kd.empty());
}

}  // namespace
}  // namespace patina::split_triangles_test
