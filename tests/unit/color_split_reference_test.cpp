#include <cmath>

#include <gtest/gtest.h>

#include "tests/reference/segmentation/color_split.h"

namespace patina::color_split_reference_test {
namespace {

using reference::ColoredVoxel;

/// Chromaticities (0.5, 0.25) and (0.25, 0.5), 0.354 apart.
constexpr glm::dvec3 kRed(0.4, 0.2, 0.2), kGreen(0.1, 0.2, 0.1);

TEST(ColorSplitReference, TwoColorsSideBySideAreApartAndUnmixed) {
    std::vector<ColoredVoxel> voxels{{glm::dvec3(0.001), {0, 0, 9}}};
    for (int i = 0; i < 10; ++i) voxels.push_back({i < 3 ? kRed : kGreen, {i, 0, 0}});
    const auto split = reference::best_color_split(voxels);
    ASSERT_TRUE(split);
    EXPECT_NEAR(split->apart, std::sqrt(0.125), 1e-12);
    EXPECT_NEAR(std::abs(split->axis.x + split->axis.y), 0, 1e-12) << "along the difference";
    EXPECT_NEAR(split->threshold, 0, 1e-12) << "half-way";
    EXPECT_EQ(split->between, 0);
    EXPECT_EQ(split->mixed, 0);
    EXPECT_EQ(split->fewer, 3u);
    EXPECT_TRUE(reference::is_of_fewer(*split, kRed));
    EXPECT_FALSE(reference::is_of_fewer(*split, kGreen));
    EXPECT_FALSE(reference::is_of_fewer(*split, 0.001 * kRed)) << "too dark to have a colour";
}

TEST(ColorSplitReference, AChequerIsMixedMoreThanByChance) {
    std::vector<ColoredVoxel> voxels;
    for (int i = 0; i < 64; ++i) voxels.push_back({(i + i / 8) % 2 == 0 ? kRed : kGreen, {i % 8, i / 8, 0}});
    const auto split = reference::best_color_split(voxels);
    ASSERT_TRUE(split);
    EXPECT_NEAR(split->mixed, 2, 1e-12) << "all of the nearest, where half of them would be by chance";
}

TEST(ColorSplitReference, OneColorHasNoSplit) {
    EXPECT_FALSE(reference::best_color_split({{kRed, {0, 0, 0}}, {kRed, {1, 0, 0}}}));
    EXPECT_FALSE(reference::best_color_split({{kRed, {0, 0, 0}}}));
}

}  // namespace
}  // namespace patina::color_split_reference_test
