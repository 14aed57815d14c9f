#include "export/same_positions.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patina::same_positions_test {

namespace {

using testing::ElementsAre;

TEST(SamePositions, AreOfTheirFirstVertex) {
    const std::vector<glm::vec3> positions_m{{1, 2, 3},     {3, 2, 1}, {1, 2, 3},      {0, 0, 0},
                                             {-0.0f, 0, 0}, {1, 2, 3}, {3, 2, 1.0001f}};
    EXPECT_THAT(first_of_position(positions_m), ElementsAre(0, 1, 0, 3, 3, 0, 6));
    EXPECT_THAT(first_of_position({}), ElementsAre());
}

TEST(SamePositions, AreFoundAmongMany) {
    std::vector<glm::vec3> positions_m;
    for (uint32_t i = 0; i < 5000; ++i) positions_m.emplace_back(i % 50, i / 50 % 10, i % 7 == 3);
    const std::vector<uint32_t> first = first_of_position(positions_m);
    for (size_t i = 0; i < first.size(); ++i) {
        const auto same = std::ranges::find(positions_m, positions_m[i]);
        EXPECT_EQ(first[i], same - positions_m.begin()) << i;
    }
}

}  // namespace

}  // namespace patina::same_positions_test
