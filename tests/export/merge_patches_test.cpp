#include "export/merge_patches.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "export/connected_vertices.h"
#include "export/tidy_surface.h"
#include "tests/export/test_meshes.h"

namespace patina::merge_patches_test {
namespace {

constexpr uint32_t kWidth = 40, kHeight = 30;
constexpr uint32_t kLeast = 32;

/// A sheet of label 1 left of column 20, and of label 2 from there on.
struct Sheet {
    Mesh mesh = test::wavy_sheet(kWidth, kHeight);
    std::vector<uint32_t> labels;

    Sheet() {
        for (uint32_t i = 0; i < kWidth * kHeight; ++i) labels.push_back(i % kWidth < 20 ? 1 : 2);
    }

    /// A rectangle of vertices gets a label.
    void put(uint32_t label, uint32_t x, uint32_t y, uint32_t width, uint32_t height) {
        for (uint32_t row = y; row < y + height; ++row)
            for (uint32_t column = x; column < x + width; ++column) labels[row * kWidth + column] = label;
    }

    uint32_t at(const std::vector<uint32_t>& all, uint32_t x, uint32_t y) const { return all[y * kWidth + x]; }

    std::vector<uint32_t> merged(uint32_t least = kLeast, bool in_pieces = false) const {
        return merged_patches(mesh, labels, least, in_pieces);
    }
};

TEST(MergePatches, ASpeckTakesTheSegmentAroundItAndALargePatchStays) {
    const Sheet plain;
    Sheet sheet;
    sheet.put(3, 5, 5, 5, 6);    // 30 vertices
    sheet.put(4, 28, 10, 4, 8);  // 32
    Sheet expected;
    expected.put(4, 28, 10, 4, 8);
    EXPECT_EQ(sheet.merged(), expected.labels);
    EXPECT_EQ(plain.merged(), plain.labels);
}

TEST(MergePatches, TheLongestBorderDecides) {
    Sheet sheet;
    sheet.put(3, 19, 10, 5, 3);  // one column in label 1, four in label 2
    Sheet expected;
    expected.put(2, 19, 10, 1, 3);
    EXPECT_EQ(sheet.merged(), expected.labels);
}

TEST(MergePatches, AnIslandOfALargeSegmentIsASpeckToo) {
    Sheet sheet;
    sheet.put(2, 5, 5, 3, 3);
    EXPECT_EQ(sheet.merged(), Sheet().labels);
}

TEST(MergePatches, NestedSpecksGoFromOutsideInwards) {
    Sheet sheet;
    sheet.put(3, 5, 5, 5, 6);
    sheet.put(4, 6, 6, 3, 3);  // touches label 3 alone, of which 21 are left
    EXPECT_EQ(sheet.merged(), Sheet().labels);
}

TEST(MergePatches, NoSegmentIsNoNeighbourAndTakesOne) {
    Sheet sheet;
    std::ranges::fill(sheet.labels, 0);
    sheet.put(3, 5, 5, 3, 3);
    EXPECT_EQ(sheet.merged(), sheet.labels) << "of surface without a label it would lose its own";
    sheet.put(2, 20, 0, 20, kHeight);
    sheet.put(3, 16, 10, 5, 3);  // one column in label 2, four in none
    Sheet expected = sheet;
    expected.put(2, 16, 10, 5, 3);
    EXPECT_EQ(sheet.merged(), expected.labels);
    Sheet hole;
    hole.put(0, 5, 5, 3, 3);
    EXPECT_EQ(hole.merged(), Sheet().labels);
}

TEST(MergePatches, WhatAPieceCutsOffMayGoOn) {
    Sheet sheet;
    sheet.put(3, 0, 5, 3, 3);
    for (uint32_t y = 0; y < kHeight; ++y) sheet.mesh.positions_m[y * kWidth].x = 0;
    EXPECT_EQ(sheet.at(sheet.merged(), 1, 6), 1u);
    EXPECT_EQ(sheet.merged(kLeast, true), sheet.labels);
}

TEST(MergePatches, NothingIsMergedWhereNoneIsAskedForOrThereAreNoLabels) {
    Sheet sheet;
    sheet.put(3, 5, 5, 3, 3);
    EXPECT_EQ(sheet.merged(0), sheet.labels);
    EXPECT_TRUE(merged_patches(sheet.mesh, {}, kLeast, false).empty());
}

TEST(MergePatches, ATidiedSurfaceHasNoSpecks) {
    Sheet sheet;
    sheet.put(3, 5, 5, 3, 3);
    MeshReflectance reflectance;
    reflectance.kd.assign(sheet.labels.size(), glm::vec4(0.3f, 0.3f, 0.3f, 1.0f));
    reflectance.labels = sheet.labels;
    reflectance.segments.resize(4);
    const auto labels_of = [&](const TidyOptions& options) {
        const TidyPiece piece = tidied(sheet.mesh, reflectance, options);
        return std::set<uint32_t>(piece.reflectance.labels.begin(), piece.reflectance.labels.end());
    };
    EXPECT_EQ(labels_of({}), (std::set<uint32_t>{1, 2}));
    EXPECT_EQ(labels_of({.least_patch_vertices = 0}), (std::set<uint32_t>{1, 2, 3}));
}

TEST(ConnectedVertices, ThoseOfOnePositionAndLabelHangTogether) {
    Sheet sheet;
    sheet.put(3, 5, 5, 4, 10);
    // The same surface, each triangle with corners of its own.
    Mesh apart;
    std::vector<uint32_t> labels;
    for (const auto& triangle : sheet.mesh.triangles) {
        const auto first = static_cast<uint32_t>(apart.positions_m.size());
        for (const uint32_t vertex : triangle) {
            apart.positions_m.push_back(sheet.mesh.positions_m[vertex]);
            labels.push_back(sheet.labels[vertex]);
        }
        apart.triangles.push_back({first, first + 1, first + 2});
    }
    ConnectedVertices connected(apart.positions_m, apart.triangles, labels);
    std::set<uint32_t> parts;
    for (uint32_t i = 0; i < labels.size(); ++i) parts.insert(connected.part_of(i));
    EXPECT_EQ(parts.size(), 3u);
}

}  // namespace
}  // namespace patina::merge_patches_test
