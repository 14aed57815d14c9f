#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/graph/plan/mutate.h"
#include "engine/graph/plan/plan.h"
#include "tests/graph/frame_builder.h"

namespace patina::graph::check_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;

/// A compiled frame to break by hand.
struct Broken {
    explicit Broken(const FrameBuilder& frame) : description(frame.description()), plan(compile(description)) {}
    std::vector<std::string> problems() const { return check(description, plan); }

    Description description;
    Plan plan;
};

/// write (storage) -> read (storage) -> replace (transfer) of one imported buffer.
FrameBuilder make_buffer_frame() {
    FrameBuilder frame;
    const uint32_t map = frame.import("map");
    const uint32_t out = frame.import("out");
    frame.pass("write", {{map, Use::kStorageWrite}})
        .pass("read", {{map, Use::kStorageRead}, {out, Use::kStorageWrite}})
        .pass("replace", {{map, Use::kTransferWrite}})
        .keep(map)
        .keep(out);
    return frame;
}

/// Two images that follow each other through one place in memory.
FrameBuilder make_image_frame() {
    FrameBuilder frame;
    const uint32_t a = frame.image("a", 64);
    const uint32_t b = frame.image("b", 64);
    const uint32_t out = frame.import("out");
    frame.pass("make a", {{a, Use::kStorageWrite}})
        .pass("copy a", {{a, Use::kTransferRead}, {out, Use::kTransferWrite}})
        .pass("make b", {{b, Use::kStorageWrite}})
        .pass("use b", {{b, Use::kSampled}, {out, Use::kStorageReadWrite}})
        .keep(out);
    return frame;
}

TEST(Check, FindsNothingInAnEmptyPlan) { EXPECT_THAT(check({}, {}), IsEmpty()); }

TEST(Check, NamesAReadThatDoesNotWaitForItsWriter) {
    Broken broken(make_buffer_frame());
    ASSERT_EQ(broken.plan.barriers[1], (Barrier{1, 0, kStorageWrites, kStorageReads, false}));
    broken.plan.barriers.erase(broken.plan.barriers.begin() + 1);
    // Without the read in between, nothing orders the two writes either.
    EXPECT_THAT(broken.problems(),
                ElementsAre("pass 'read', which reads 'map', does not wait for pass 'write', which writes 'map'",
                            "pass 'replace', which writes 'map', waits for pass 'write', which writes 'map', but does "
                            "not see what that wrote"));
}

TEST(Check, NamesAReadThatDoesNotSeeItsWrite) {
    Broken broken(make_buffer_frame());
    broken.plan.barriers[1].destination.accesses = kAccessUniformRead;
    EXPECT_THAT(broken.problems(), ElementsAre("pass 'read', which reads 'map', waits for pass 'write', which writes "
                                               "'map', but does not see what that wrote"));
}

TEST(Check, NamesAWriteThatIsNeverMadeAvailable) {
    Broken broken(make_buffer_frame());
    broken.plan.barriers[1].source.accesses = kAccessNone;
    EXPECT_THAT(broken.problems(), Contains("pass 'read', which reads 'map', waits for pass 'write', which writes "
                                            "'map', but does not see what that wrote"));
}

TEST(Check, TakesAWriteForAvailableOnlyThroughItsOwnStage) {
    Broken broken(make_buffer_frame());
    broken.plan.barriers[1].source.accesses = kAccessNone;
    broken.plan.barriers[1].destination.stages |= kStageTransfer;
    broken.plan.barriers[2].source = {kStageTransfer, kAccessStorageWrite};
    EXPECT_THAT(broken.problems(), Contains("pass 'replace', which writes 'map', waits for pass 'write', which writes "
                                            "'map', but does not see what that wrote"));
}

TEST(Check, IgnoresAccessesOfStagesThatABarrierDoesNotName) {
    Broken broken(make_buffer_frame());
    broken.plan.barriers[1].destination = {kStageTransfer, kAccessStorageRead};
    const Barrier execution_only{1, 0, kComputeStage, kComputeStage, false};
    broken.plan.barriers.insert(broken.plan.barriers.begin() + 2, execution_only);
    EXPECT_THAT(broken.problems(), Contains("pass 'read', which reads 'map', waits for pass 'write', which writes "
                                            "'map', but does not see what that wrote"));
}

TEST(Check, NamesAWriteThatDoesNotWaitForAReader) {
    Broken broken(make_buffer_frame());
    ASSERT_EQ(broken.plan.barriers[2], (Barrier{2, 0, kComputeStage, kTransferWrites, false}));
    broken.plan.barriers.pop_back();
    EXPECT_THAT(broken.problems(),
                ElementsAre("pass 'replace', which writes 'map', does not wait for pass 'write', which writes 'map'",
                            "pass 'replace', which writes 'map', does not wait for pass 'read', which reads 'map'"));
}

TEST(Check, TakesABarrierOnOneResourceForNoOther) {
    Broken broken(make_buffer_frame());
    broken.plan.barriers[1].resource = 1;
    EXPECT_THAT(broken.problems(),
                Contains("pass 'read', which reads 'map', does not wait for pass 'write', which writes 'map'"));
}

TEST(Check, NamesABarrierThatComesTooLate) {
    Broken broken(make_buffer_frame());
    broken.plan.barriers[1].before = 2;
    EXPECT_THAT(broken.problems(),
                Contains("pass 'read', which reads 'map', does not wait for pass 'write', which writes 'map'"));
}

TEST(Check, DoesNotChainBarriersBeforeOnePass) {
    Broken broken(make_buffer_frame());
    broken.plan.barriers.pop_back();
    broken.plan.barriers.push_back({2, 0, kComputeStage, kIndirectReads, false});
    broken.plan.barriers.push_back({2, 0, {kStageIndirect, kAccessNone}, kTransferWrites, false});
    EXPECT_THAT(broken.problems(),
                Contains("pass 'replace', which writes 'map', does not wait for pass 'read', which reads 'map'"));
}

TEST(Check, NamesEveryAccessWithoutAFrameBoundary) {
    Broken broken(make_buffer_frame());
    broken.plan.barriers.erase(broken.plan.barriers.begin());
    EXPECT_THAT(broken.problems(), ElementsAre("pass 'write', which writes 'map', does not wait for earlier frames",
                                               "pass 'read', which reads 'map', does not wait for earlier frames",
                                               "pass 'replace', which writes 'map', does not wait for earlier frames",
                                               "pass 'read', which writes 'out', does not wait for earlier frames"));
}

TEST(Check, NamesAStageThatTheFrameBoundaryForgets) {
    Broken broken(make_buffer_frame());
    broken.plan.barriers[0].source.stages = kStageCompute | kStageTransfer;
    EXPECT_THAT(broken.problems(), Contains("pass 'write', which writes 'map', does not wait for earlier frames"));
}

TEST(Check, NamesAnImageWithoutALayout) {
    Broken broken(make_image_frame());
    ASSERT_EQ(broken.plan.barriers[1], (Barrier{0, 0, kEarlierFrames, kStorageWrites, true}));
    broken.plan.barriers.erase(broken.plan.barriers.begin() + 1);
    EXPECT_THAT(broken.problems(), ElementsAre("pass 'make a', which writes 'a', finds it in an undefined layout",
                                               "pass 'copy a', which reads 'a', finds it in an undefined layout"));
}

TEST(Check, NamesATransitionThatDoesNotWaitForEarlierFrames) {
    Broken broken(make_image_frame());
    broken.plan.barriers[1].source = kComputeStage;  // the boundary before the same pass does not help
    EXPECT_THAT(broken.problems(),
                ElementsAre("the transition of 'a' before pass 'make a' does not wait for earlier frames"));
}

TEST(Check, NamesATransitionThatDoesNotSeeWhatEarlierFramesWrote) {
    Broken broken(make_image_frame());
    broken.plan.barriers[1].source.accesses = kAccessNone;
    EXPECT_THAT(broken.problems(),
                ElementsAre("the transition of 'a' before pass 'make a' does not wait for earlier frames"));
}

TEST(Check, NamesAnImageInTheLayoutOfAnotherOne) {
    Broken broken(make_image_frame());
    broken.plan.barriers[3].discard = false;
    EXPECT_THAT(broken.problems(), ElementsAre("pass 'make b', which writes 'b', finds it in an undefined layout",
                                               "pass 'use b', which reads 'b', finds it in an undefined layout"));
}

TEST(Check, NamesATransitionThatDoesNotWaitForTheMemorysLastUser) {
    Broken broken(make_image_frame());
    Barrier& second = broken.plan.barriers[3];
    ASSERT_EQ(second, (Barrier{2, 1, kTransferStage, kStorageWrites, true}));
    second.source = kComputeStage;
    EXPECT_THAT(
        broken.problems(),
        ElementsAre("the transition of 'b' before pass 'make b' does not wait for pass 'copy a', which reads 'a'",
                    "pass 'make b', which writes 'b', does not wait for pass 'copy a', which reads 'a'"));
}

TEST(Check, NamesAccessesThatDoNotWaitForTheTransition) {
    Broken broken(make_image_frame());
    broken.plan.barriers[3].destination = kTransferWrites;
    const std::string transition = "does not wait for the transition of 'b' before pass 'make b'";
    EXPECT_THAT(broken.problems(), Contains("pass 'make b', which writes 'b', " + transition));
    EXPECT_THAT(broken.problems(), Contains("pass 'use b', which reads 'b', " + transition))
        << "the barrier behind 'make b' does not reach back to the transition";
}

TEST(Check, NamesADiscardOfContentThatIsStillRead) {
    Broken broken(make_image_frame());
    ASSERT_EQ(broken.plan.barriers[2].before, 1u);
    broken.plan.barriers[2].discard = true;
    EXPECT_THAT(broken.problems(),
                ElementsAre("pass 'copy a', which reads 'a', wants version 1 of it and finds nothing defined"));
}

TEST(Check, NamesMemoryThatIsSharedTooEarly) {
    FrameBuilder frame;
    const uint32_t a = frame.buffer("a", 64);
    const uint32_t b = frame.buffer("b", 64);
    const uint32_t out = frame.import("out");
    frame.pass("make a", {{a, Use::kStorageWrite}})
        .pass("make b", {{b, Use::kStorageWrite}})
        .pass("sum", {{a, Use::kStorageRead}, {b, Use::kStorageRead}, {out, Use::kStorageWrite}})
        .keep(out);
    Broken broken(frame);
    broken.plan.placements[b]->offset = 32;
    EXPECT_THAT(broken.problems(), Contains("pass 'make b', which writes 'b', does not wait for pass 'make a', which "
                                            "writes 'a'"));
    EXPECT_THAT(broken.problems(),
                Contains("pass 'sum', which reads 'a', wants version 1 of it and finds version 1 of 'b'"));
}

TEST(Check, NamesContentThatACulledPassShouldHaveMade) {
    Broken broken(make_buffer_frame());
    broken.plan.order = {1, 2};
    broken.plan.culled = {0};
    broken.plan.barriers = {{0, std::nullopt, kEarlierFrames, kStorageReadWrites | kTransferWrites, false},
                            {1, 0, kComputeStage, kTransferWrites, false}};
    EXPECT_THAT(broken.problems(),
                ElementsAre("pass 'read', which reads 'map', wants version 1 of it and finds version 0 of 'map'"));
}

TEST(Check, NamesAKeptVersionThatIsLost) {
    Broken broken(make_buffer_frame());
    broken.plan.order = {0, 1};
    broken.plan.culled = {2};
    broken.plan.barriers.pop_back();
    EXPECT_THAT(broken.problems(),
                ElementsAre("version 2 of 'map' is kept, but the frame ends with version 1 of 'map' in its memory"));
}

TEST(Check, NamesPlansThatCannotBeRun) {
    const Broken sound(make_image_frame());
    Broken broken = sound;
    broken.plan.order[1] = 0;
    EXPECT_THAT(broken.problems(), ElementsAre("the plan misses pass 1 or has it twice"));
    broken = sound;
    broken.plan.order.pop_back();
    EXPECT_THAT(broken.problems(), Contains("the plan has 3 passes of 4"));
    broken = sound;
    broken.plan.placements.clear();
    EXPECT_THAT(broken.problems(), ElementsAre("the plan has placements for 0 resources of 3"));
    broken = sound;
    broken.plan.placements[1]->offset = 1;
    EXPECT_THAT(broken.problems(), Contains("'b' has no fitting place in its arena"));
    broken = sound;
    std::swap(broken.plan.barriers[0], broken.plan.barriers.back());
    EXPECT_THAT(broken.problems(), Contains("barrier 1 is out of order"));
    broken = sound;
    broken.plan.barriers[2].resource = 9;
    EXPECT_THAT(broken.problems(), ElementsAre("barrier 2 names a pass or resource that the plan lacks"));
    broken = sound;
    broken.plan.barriers[0].discard = true;
    EXPECT_THAT(broken.problems(), ElementsAre("barrier 0 discards something that is no image"));
}

TEST(FindUnneededBarriers, ListsThoseWhoseDeletionChangesNothing) {
    Broken broken(make_buffer_frame());
    EXPECT_THAT(find_unneeded_barriers(broken.description, broken.plan), IsEmpty());
    const Barrier twice = broken.plan.barriers[1];
    broken.plan.barriers.insert(broken.plan.barriers.begin() + 1, twice);
    const std::string unneeded = "the barrier on 'map' before pass 'read' is not needed";
    EXPECT_THAT(find_unneeded_barriers(broken.description, broken.plan), ElementsAre(unneeded, unneeded));
}

}  // namespace
}  // namespace patina::graph::check_test
