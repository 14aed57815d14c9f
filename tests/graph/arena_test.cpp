#include "engine/graph/plan/arena.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patina::graph::arena_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

TEST(Arena, OfNothingIsEmpty) {
    const ArenaLayout layout = lay_out_arena({});
    EXPECT_THAT(layout.placements, IsEmpty());
    EXPECT_EQ(layout.total, (MemoryNeed{0, 1}));
}

TEST(Arena, KeepsOverlappingLifetimesApartAndAligned) {
    const std::vector<ArenaRequest> requests = {{{10, 1}, {0, 1}}, {{9, 16}, {1, 2}}, {{6, 2}, {1, 1}}};
    const ArenaLayout layout = lay_out_arena(requests);
    // The last one fits between the first two.
    EXPECT_THAT(layout.placements, ElementsAre(Placement{0, 10}, Placement{16, 9}, Placement{10, 6}));
    EXPECT_EQ(layout.total, (MemoryNeed{25, 16}));
}

TEST(Arena, SharesMemoryBetweenLifetimesThatOnlyTouch) {
    const std::vector<ArenaRequest> requests = {{{8, 1}, {0, 1}}, {{8, 1}, {2, 3}}, {{4, 1}, {4, 4}}};
    const ArenaLayout layout = lay_out_arena(requests);
    EXPECT_THAT(layout.placements, ElementsAre(Placement{0, 8}, Placement{0, 8}, Placement{0, 4}));
    EXPECT_EQ(layout.total.bytes, 8u);
}

TEST(Arena, PlacesLargeRequestsFirstThenEarlyOnes) {
    const std::vector<ArenaRequest> requests = {{{4, 1}, {1, 2}}, {{4, 1}, {0, 2}}, {{8, 1}, {2, 2}}};
    EXPECT_THAT(lay_out_arena(requests).placements, ElementsAre(Placement{12, 4}, Placement{8, 4}, Placement{0, 8}));
}

TEST(ArenaOccupancy, NamesTheLastUsersOfEachByte) {
    ArenaOccupancy occupancy;
    EXPECT_THAT(occupancy.claim({0, 10}, 1), IsEmpty());
    EXPECT_THAT(occupancy.claim({10, 10}, 2), IsEmpty());
    EXPECT_THAT(occupancy.claim({5, 10}, 3), UnorderedElementsAre(1, 2));
    EXPECT_THAT(occupancy.claim({0, 5}, 4), ElementsAre(1));
    EXPECT_THAT(occupancy.claim({6, 2}, 5), ElementsAre(3));
    EXPECT_THAT(occupancy.claim({0, 20}, 6), UnorderedElementsAre(2, 3, 4, 5));
    EXPECT_THAT(occupancy.claim({0, 20}, 7), ElementsAre(6));
}

}  // namespace
}  // namespace patina::graph::arena_test
