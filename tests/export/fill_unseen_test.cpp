#include "export/fill_unseen.h"

#include <gtest/gtest.h>

namespace patina::fill_unseen_test {
namespace {

/// A strip of so many squares along x, white, of segment 7.
struct Strip {
    explicit Strip(uint32_t squares) {
        for (uint32_t i = 0; i <= squares; ++i) {
            for (const float y : {0.0f, 1.0f}) {
                mesh.positions_m.emplace_back(float(i), y, 0);
                mesh.normals.emplace_back(0, 0, 1);
                mesh.colors.emplace_back(0.5f);
                reflectance.kd.emplace_back(0.8f, 0.8f, 0.8f, 1);
                reflectance.labels.push_back(7);
            }
            if (i == 0) continue;
            const uint32_t at = 2 * i;
            mesh.triangles.push_back({at - 2, at, at - 1});
            mesh.triangles.push_back({at, at + 1, at - 1});
        }
        reflectance.segments.resize(10);
    }

    void forget(uint32_t vertex) {
        mesh.colors[vertex] = glm::vec3(0);
        reflectance.kd[vertex] = glm::vec4(0);
        reflectance.labels[vertex] = 0;
    }

    Mesh mesh;
    MeshReflectance reflectance;
};

TEST(FillUnseen, WhatNoColourPictureSawGoesOnAsWhatIsBesideIt) {
    Strip strip(20);
    for (uint32_t vertex = 20; vertex < 42; ++vertex) strip.forget(vertex);
    for (uint32_t vertex = 0; vertex < 4; ++vertex) strip.reflectance.labels[vertex] = 3;
    const auto filled = filled_unseen(strip.mesh, strip.reflectance);
    ASSERT_TRUE(filled);
    EXPECT_EQ(filled->vertices, 22u);
    for (uint32_t vertex = 0; vertex < 42; ++vertex) {
        EXPECT_EQ(filled->mesh.colors[vertex], glm::vec3(0.5f)) << vertex;
        EXPECT_EQ(filled->reflectance.kd[vertex], glm::vec4(0.8f, 0.8f, 0.8f, vertex < 20 ? 1 : 0.5f)) << vertex;
        EXPECT_EQ(filled->reflectance.labels[vertex], vertex < 4 ? 3u : 7u) << vertex;
    }
    EXPECT_EQ(filled->mesh.triangles, strip.mesh.triangles);
}

TEST(FillUnseen, TheNearestCounts) {
    Strip strip(5);
    for (uint32_t vertex = 4; vertex < 8; ++vertex) strip.forget(vertex);  // at x = 2 and 3
    for (const uint32_t vertex : {8u, 9u, 10u, 11u}) {
        strip.reflectance.kd[vertex] = glm::vec4(0.2f, 0.2f, 0.2f, 1);
        strip.reflectance.labels[vertex] = 9;
    }
    const auto filled = filled_unseen(strip.mesh, strip.reflectance);
    ASSERT_TRUE(filled);
    for (const uint32_t vertex : {4u, 5u}) EXPECT_EQ(filled->reflectance.kd[vertex].r, 0.8f) << vertex;
    for (const uint32_t vertex : {6u, 7u}) {
        EXPECT_EQ(filled->reflectance.kd[vertex].r, 0.2f) << vertex;
        EXPECT_EQ(filled->reflectance.labels[vertex], 9u) << vertex;
    }
}

TEST(FillUnseen, AnAlbedoWithoutAColourDarkensNone) {
    Strip strip(2);
    strip.forget(4);
    strip.mesh.colors[2] = glm::vec3(0);  // beside it, as 3 and 5 are
    const auto filled = filled_unseen(strip.mesh, strip.reflectance);
    ASSERT_TRUE(filled);
    EXPECT_EQ(filled->mesh.colors[4], glm::vec3(0.5f));
    EXPECT_EQ(filled->mesh.colors[2], glm::vec3(0)) << "it was seen";
}

TEST(FillUnseen, WhereAllOrNothingWasSeenAllStays) {
    Strip strip(4);
    EXPECT_FALSE(filled_unseen(strip.mesh, strip.reflectance));
    strip.mesh.colors[3] = glm::vec3(0);
    EXPECT_FALSE(filled_unseen(strip.mesh, strip.reflectance)) << "its albedo is known";
    EXPECT_TRUE(filled_unseen(strip.mesh, {})) << "colours alone";
    for (uint32_t vertex = 0; vertex < 10; ++vertex) strip.forget(vertex);
    EXPECT_FALSE(filled_unseen(strip.mesh, strip.reflectance));
}

}  // namespace
}  // namespace patina::fill_unseen_test
