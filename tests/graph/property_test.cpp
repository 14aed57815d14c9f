#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/graph/plan/mutate.h"
#include "engine/graph/plan/plan.h"
#include "tests/graph/random_frame.h"

namespace patina::graph::property_test {
namespace {

using testing::IsEmpty;
using testing::Not;

constexpr uint32_t kFrames = 600;

bool overlap(const Lifetime& a, const Lifetime& b) { return a.first <= b.last && b.first <= a.last; }
bool overlap(const Placement& a, const Placement& b) {
    return a.offset < b.offset + b.bytes && b.offset < a.offset + a.bytes;
}

TEST(RandomFrames, CompileToPlansInWhichTheCheckerFindsNothing) {
    for (uint32_t seed = 0; seed < kFrames; ++seed) {
        const Description description = make_random_frame(seed);
        EXPECT_THAT(check(description, compile(description)), IsEmpty()) << "seed " << seed;
    }
}

TEST(RandomFrames, CompileToTheSamePlanEveryTime) {
    for (uint32_t seed = 0; seed < kFrames; ++seed) {
        const Description description = make_random_frame(seed);
        EXPECT_EQ(compile(description), compile(Description(description))) << "seed " << seed;
    }
}

TEST(RandomFrames, NeedEachBarrier) {
    for (uint32_t seed = 0; seed < kFrames; ++seed) {
        const Description description = make_random_frame(seed);
        EXPECT_THAT(find_unneeded_barriers(description, compile(description)), IsEmpty()) << "seed " << seed;
    }
}

/// Each barrier's source and destination without one of their stages.
std::vector<Plan> narrowed(const Plan& plan) {
    std::vector<Plan> mutants;
    for (size_t i = 0; i < plan.barriers.size(); ++i) {
        for (Scope Barrier::*side : {&Barrier::source, &Barrier::destination}) {
            for (uint32_t stage : {kStageCompute, kStageTransfer, kStageIndirect}) {
                if (!((plan.barriers[i].*side).stages & stage)) continue;
                mutants.push_back(plan);
                (mutants.back().barriers[i].*side).stages &= ~stage;
            }
        }
    }
    return mutants;
}

TEST(RandomFrames, NeedEachStageOfEachBarrier) {
    for (uint32_t seed = 0; seed < kFrames; ++seed) {
        const Description description = make_random_frame(seed);
        for (const Plan& mutant : narrowed(compile(description))) {
            EXPECT_THAT(check(description, mutant), Not(IsEmpty())) << "seed " << seed << '\n'
                                                                    << to_json(description, mutant);
        }
    }
}

TEST(RandomFrames, NeedTheDestinationAccessesOfEachBarrierBehindAWrite) {
    for (uint32_t seed = 0; seed < kFrames; ++seed) {
        const Description description = make_random_frame(seed);
        const Plan plan = compile(description);
        for (size_t i = 0; i < plan.barriers.size(); ++i) {
            if (plan.barriers[i].source.accesses == kAccessNone) continue;
            Plan mutant = plan;
            mutant.barriers[i].destination.accesses = kAccessNone;
            EXPECT_THAT(check(description, mutant), Not(IsEmpty())) << "seed " << seed << " barrier " << i;
            mutant = plan;
            mutant.barriers[i].source.accesses = kAccessNone;
            EXPECT_THAT(check(description, mutant), Not(IsEmpty())) << "seed " << seed << " barrier " << i;
        }
    }
}

TEST(RandomFrames, ShareMemoryOnlyBetweenLifetimesThatDoNotOverlap) {
    size_t shared = 0;
    for (uint32_t seed = 0; seed < kFrames; ++seed) {
        const Description description = make_random_frame(seed);
        const Plan plan = compile(description);
        for (size_t a = 0; a < description.resources.size(); ++a) {
            for (size_t b = 0; b < a; ++b) {
                const bool same_arena = description.resources[a].kind == description.resources[b].kind;
                if (!same_arena || !plan.placements[a] || !plan.placements[b]) continue;
                if (!overlap(*plan.placements[a], *plan.placements[b])) continue;
                EXPECT_FALSE(overlap(*plan.lifetimes[a], *plan.lifetimes[b]))
                    << "seed " << seed << ' ' << a << ' ' << b;
                ++shared;
            }
        }
    }
    EXPECT_GT(shared, kFrames / 2) << "the frames hardly alias, so they test little";
}

TEST(RandomFrames, HaveLifetimesFromFirstToLastUse) {
    for (uint32_t seed = 0; seed < kFrames; ++seed) {
        const Description description = make_random_frame(seed);
        const Plan plan = compile(description);
        for (uint32_t resource = 0; resource < description.resources.size(); ++resource) {
            std::vector<uint32_t> positions;
            for (uint32_t position = 0; position < plan.order.size(); ++position) {
                for (const Access& access : description.passes[plan.order[position]].accesses) {
                    if (access.resource == resource) positions.push_back(position);
                }
            }
            ASSERT_EQ(plan.lifetimes[resource].has_value(), !positions.empty()) << "seed " << seed;
            if (positions.empty()) continue;
            bool kept = false;
            for (const Keep& keep : description.kept) kept = kept || keep.resource == resource;
            const uint32_t last = kept ? static_cast<uint32_t>(plan.order.size() - 1) : positions.back();
            EXPECT_EQ(*plan.lifetimes[resource], (Lifetime{positions.front(), last})) << "seed " << seed;
        }
    }
}

}  // namespace
}  // namespace patina::graph::property_test
