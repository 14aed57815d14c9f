#include "sensor/recentred_source.h"

#include <gtest/gtest.h>

#include "tests/sensor/sequences.h"

namespace patina::sensor::recentred_source_test {
namespace {

TEST(RecentredSource, WorldsNearTheirOriginStay) {
    EXPECT_EQ(world_offset_m({999, 0, 0}), glm::dvec3(0));
    EXPECT_EQ(world_offset_m({1e6 + 0.4, -2e6 - 0.6, 0.5}), glm::dvec3(1e6, -2e6 - 1, 1));
}

TEST(RecentredSource, TakesTheOffsetFromPosesAlone) {
    std::vector<Reading> readings = testing::test_readings(3);
    std::get<Frame>(readings[1]).world_from_camera.reset();
    readings[2] = Skipped{2, "damaged"};
    RecentredSource source(std::make_unique<testing::MemorySource>(testing::test_info(), readings), {1, 2, -3});
    const std::vector<Reading> moved = testing::read_all(source);
    ASSERT_EQ(moved.size(), 3u);
    RigidTransform expected = *std::get<Frame>(readings[0]).world_from_camera;
    expected[3] += glm::dvec4(-1, -2, 3, 0);
    EXPECT_EQ(*std::get<Frame>(moved[0]).world_from_camera, expected);
    EXPECT_FALSE(std::get<Frame>(moved[1]).world_from_camera);
    EXPECT_EQ(std::get<Skipped>(moved[2]).reason, "damaged");
}

}  // namespace
}  // namespace patina::sensor::recentred_source_test
