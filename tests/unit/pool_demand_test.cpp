#include "passes/state/pool_demand.h"

#include <gtest/gtest.h>

namespace patina::pool_demand_test {
namespace {

PoolCount counted(uint32_t capacity, uint32_t free, uint32_t refused = 0, uint32_t deleted = 0) {
    return {capacity, free, capacity - free + deleted, refused};
}

constexpr uint32_t kLargeStep = 1u << 20;

TEST(PoolDemand, BlocksInUseAndThoseGivenBackWereTaken) {
    gpu::MapCounters counters{};
    counters.capacity = 100;
    counters.free_blocks = 60;
    counters.deleted_blocks = 7;
    counters.left_blocks = 9;
    counters.returned_blocks = 9;
    counters.refused_blocks = 3;
    const PoolCount count = count_of(counters);
    EXPECT_EQ(count.capacity, 100u);
    EXPECT_EQ(count.free, 60u);
    EXPECT_EQ(count.taken, 47u);
    EXPECT_EQ(count.refused, 3u);
}

TEST(PoolDemand, BlocksThatLeaveAndComeBackAreNoNewOnes) {
    gpu::MapCounters counters{};
    counters.capacity = 100;
    counters.free_blocks = 60;
    const uint32_t taken = count_of(counters).taken;
    counters.free_blocks += 25;
    counters.left_blocks += 25;
    EXPECT_EQ(count_of(counters).taken, taken);
    counters.free_blocks -= 20;
    counters.returned_blocks += 20;
    EXPECT_EQ(count_of(counters).taken, taken);
    counters.free_blocks -= 3;
    EXPECT_EQ(count_of(counters).taken, taken + 3);
}

TEST(PoolDemand, WhatComesBackFindsRoomBesidesWhatIsNew) {
    PoolDemand demand;
    demand.note(counted(100, 70));  // 30 at once
    EXPECT_EQ(demand.wanted(100, 10, 10), 100u) << "70 are free, twice 30 and 10";
    EXPECT_EQ(demand.wanted(100, 10, 11), 110u);
    EXPECT_EQ(demand.wanted(100, 10, 50), 140u) << "as many as are missing";
}

TEST(PoolDemand, APoolThatWasNeverAskedStaysAsItIs) { EXPECT_EQ(PoolDemand().wanted(100, kLargeStep), 100u); }

TEST(PoolDemand, ThereIsAlwaysRoomForTwoFramesAsGreedyAsTheGreediest) {
    PoolDemand demand;
    demand.note(counted(100, 70));  // 30 at once
    EXPECT_EQ(demand.wanted(100, kLargeStep), 100u);
    demand.note(counted(100, 60));
    EXPECT_EQ(demand.wanted(100, kLargeStep), 100u) << "60 are free, twice 30";
    demand.note(counted(100, 59));
    EXPECT_EQ(demand.wanted(100, kLargeStep), 200u);
    EXPECT_EQ(demand.used(), 41u);
}

TEST(PoolDemand, ItDoublesButTakesNoMoreThanAStep) {
    PoolDemand demand;
    demand.note(counted(1000, 500));
    EXPECT_EQ(demand.wanted(1000, 700), 1700u);
    EXPECT_EQ(demand.wanted(1000, kLargeStep), 2000u);
}

TEST(PoolDemand, WhatIsMissingCountsMoreThanTheStep) {
    PoolDemand demand;
    demand.note(counted(100, 0, 900));
    // 100 found room and 900 did not: twice 1000 are needed, and the 900.
    EXPECT_EQ(demand.wanted(100, 10), 100u + 2900u);
    EXPECT_EQ(demand.refused(), 900u);
}

TEST(PoolDemand, WhatIsRefusedAlthoughPlacesAreFreeNeedsMorePlaces) {
    PoolDemand demand;
    demand.note(counted(100, 97, 1));  // a label that is given and lies beyond the capacity
    EXPECT_EQ(demand.wanted(100, kLargeStep), 200u);
}

TEST(PoolDemand, WhatGrewSinceTheCountersWereTakenIsFree) {
    PoolDemand demand;
    demand.note(counted(100, 40, 0));
    EXPECT_EQ(demand.wanted(100, kLargeStep), 200u);
    EXPECT_EQ(demand.wanted(200, kLargeStep), 200u) << "the frames after the growth are not counted yet";
    demand.note(counted(200, 130));
    EXPECT_EQ(demand.wanted(200, kLargeStep), 200u);
}

TEST(PoolDemand, BlocksThatWereGivenBackWereAskedFor) {
    PoolDemand demand;
    demand.note(counted(100, 90));
    // 35 came and 20 of them or of the others went.
    demand.note(counted(100, 75, 0, 20));
    EXPECT_EQ(demand.wanted(100, kLargeStep), 100u) << "75 are free, twice 35 are 70";
    demand.note(counted(100, 69, 0, 20));
    EXPECT_EQ(demand.wanted(100, kLargeStep), 200u);
}

}  // namespace
}  // namespace patina::pool_demand_test
