#include "export/mesh_parts.h"

#include <gmock/gmock.h>

namespace patina::mesh_parts_test {
namespace {

using testing::ElementsAre;
using Triangle = std::array<uint32_t, 3>;

TEST(MeshParts, WithoutLabelsAllIsOnePart) {
    const std::vector<Triangle> triangles{{2, 1, 0}};
    const auto parts = parts_by_label(4, triangles, {});
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts[0].label, 0u);
    EXPECT_THAT(parts[0].vertices, ElementsAre(0, 1, 2, 3));
    EXPECT_THAT(parts[0].triangles, ElementsAre(Triangle{2, 1, 0}));
}

TEST(MeshParts, EachSegmentHasItsTrianglesAndTheirVertices) {
    const std::vector<uint32_t> labels{7, 7, 3, 3, 3};
    const std::vector<Triangle> triangles{{0, 1, 2}, {1, 2, 3}, {2, 3, 4}};
    const auto parts = parts_by_label(5, triangles, labels);
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].label, 3u) << "two of {1, 2, 3} agree on 3";
    EXPECT_THAT(parts[0].vertices, ElementsAre(1, 2, 3, 4));
    EXPECT_THAT(parts[0].triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{1, 2, 3}));
    EXPECT_EQ(parts[1].label, 7u);
    EXPECT_THAT(parts[1].vertices, ElementsAre(0, 1, 2)) << "vertices between segments are each one's own";
    EXPECT_THAT(parts[1].triangles, ElementsAre(Triangle{0, 1, 2}));
}

TEST(MeshParts, WhereThreeSegmentsMeetTheFirstVertexDecides) {
    const std::vector<uint32_t> labels{9, 0, 4};
    const std::vector<Triangle> triangles{{1, 2, 0}};
    const auto parts = parts_by_label(3, triangles, labels);
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts[0].label, 0u);
}

TEST(MeshParts, OfNothingThereAreNone) { EXPECT_TRUE(parts_by_label(0, {}, std::vector<uint32_t>{1}).empty()); }

}  // namespace
}  // namespace patina::mesh_parts_test
