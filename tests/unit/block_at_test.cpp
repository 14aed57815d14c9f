#include "passes/state/block_at.h"

#include <limits>

#include <gtest/gtest.h>

namespace patina::block_at_test {
namespace {

TEST(BlockAt, PointsLieInTheBlockBelowThem) {
    EXPECT_EQ(block_at({0, 0.999, 1}), glm::ivec3(0, 0, 1));
    EXPECT_EQ(block_at({-0.001, -1, -1.001}), glm::ivec3(-1, -1, -2));
}

TEST(BlockAt, FarPointsLieInTheFarthestBlockWhoseVoxelsHaveCoordinates) {
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(block_at({1e12, -1e300, infinity}), glm::ivec3(1 << 27, -(1 << 27), 1 << 27));
}

}  // namespace
}  // namespace patina::block_at_test
