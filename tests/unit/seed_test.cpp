#include "engine/core/seed.h"

#include <set>

#include <gtest/gtest.h>

namespace patina::seed_test {
namespace {

TEST(SeedOfDraw, IsItsOwnForARunOfSeedZero) {
    for (const uint32_t own : {0u, 1u, 7u, 0xffffffffu}) EXPECT_EQ(seed_of_draw(own, 0), own);
}

TEST(SeedOfDraw, DiffersForEverySeedOfARun) {
    std::set<uint32_t> seen;
    for (uint64_t run = 0; run < 1000; ++run) {
        seen.insert(seed_of_draw(1, run));
        seen.insert(seed_of_draw(1, (run + 1) << 32));  // the upper half counts too
    }
    EXPECT_EQ(seen.size(), 2000u);
    // Draws of frame i use seed + i: runs of neighbouring seeds must not repeat each other's a frame later.
    for (uint32_t run = 0; run < 1000; ++run) {
        const uint32_t apart = seed_of_draw(1, run + 1) - seed_of_draw(1, run);
        EXPECT_GT(apart + 100000u, 200000u) << run;
    }
}

}  // namespace
}  // namespace patina::seed_test
