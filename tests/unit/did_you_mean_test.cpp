#include "engine/core/did_you_mean.h"

#include <vector>

#include <gtest/gtest.h>

namespace patina::did_you_mean_test {
namespace {

TEST(DidYouMean, DistanceCountsTheFourMistakesOfTyping) {
    EXPECT_EQ(edit_distance("frames", "frames"), 0u);
    EXPECT_EQ(edit_distance("frmaes", "frames"), 1u) << "two letters swapped";
    EXPECT_EQ(edit_distance("frmes", "frames"), 1u) << "one left out";
    EXPECT_EQ(edit_distance("framess", "frames"), 1u) << "one too many";
    EXPECT_EQ(edit_distance("fromes", "frames"), 1u) << "one wrong";
    EXPECT_EQ(edit_distance("", "frames"), 6u);
    EXPECT_EQ(edit_distance("frames", ""), 6u);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
    EXPECT_EQ(edit_distance("sitting", "kitten"), 3u) << "symmetric";
}

TEST(DidYouMean, NamesTheNearestWordAndTheFirstOfEquals) {
    const std::vector<std::string> words{"map.voxel_m", "map.capacity_blocks", "view.near_m", "view.neat_m"};
    EXPECT_EQ(did_you_mean("map.voxel", words), "; did you mean 'map.voxel_m'?");
    EXPECT_EQ(did_you_mean("map.capacity_block", words), "; did you mean 'map.capacity_blocks'?");
    EXPECT_EQ(did_you_mean("view.nea_m", words), "; did you mean 'view.near_m'?");
}

TEST(DidYouMean, WhatIsLikeNoneIsNotGuessed) {
    const std::vector<std::string> words{"on", "off", "auto"};
    EXPECT_EQ(did_you_mean("maybe", words), "");
    EXPECT_EQ(did_you_mean("", words), "");
    EXPECT_EQ(did_you_mean("on", std::vector<std::string>{}), "");
    EXPECT_EQ(did_you_mean(std::string(100000, 'o'), words), "");
}

}  // namespace
}  // namespace patina::did_you_mean_test
