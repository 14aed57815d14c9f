#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/graph/plan/plan.h"
#include "tests/graph/frame_builder.h"

namespace patina::graph::compile_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Scope, IsStageAndAccessesOfEachUse) {
    EXPECT_EQ(scope_of(Use::kStorageRead), (Scope{kStageCompute, kAccessStorageRead}));
    EXPECT_EQ(scope_of(Use::kStorageWrite), (Scope{kStageCompute, kAccessStorageWrite}));
    EXPECT_EQ(scope_of(Use::kStorageReadWrite), (Scope{kStageCompute, kAccessStorageRead | kAccessStorageWrite}));
    EXPECT_EQ(scope_of(Use::kSampled), (Scope{kStageCompute, kAccessSampledRead}));
    EXPECT_EQ(scope_of(Use::kUniform), (Scope{kStageCompute, kAccessUniformRead}));
    EXPECT_EQ(scope_of(Use::kIndirect), (Scope{kStageIndirect, kAccessIndirectRead}));
    EXPECT_EQ(scope_of(Use::kTransferRead), (Scope{kStageTransfer, kAccessTransferRead}));
    EXPECT_EQ(scope_of(Use::kTransferWrite), (Scope{kStageTransfer, kAccessTransferWrite}));
}

TEST(Compile, MakesNothingOfAnEmptyFrame) { EXPECT_EQ(compile({}), Plan{}); }

TEST(Compile, CullsEveryPassWhenNothingIsKept) {
    FrameBuilder frame;
    const uint32_t map = frame.import("map");
    frame.pass("write", {{map, Use::kStorageReadWrite}});
    const Plan plan = compile(frame.description());
    EXPECT_THAT(plan.order, IsEmpty());
    EXPECT_THAT(plan.culled, ElementsAre(0));
    EXPECT_THAT(plan.lifetimes, ElementsAre(std::nullopt));
    EXPECT_THAT(plan.barriers, IsEmpty());
}

TEST(Compile, CullsPassesThatFeedNothingKept) {
    FrameBuilder frame;
    const uint32_t map = frame.import("map");
    const uint32_t view = frame.image("view", 8);
    const uint32_t debug = frame.image("debug", 8);
    frame.pass("integrate", {{map, Use::kStorageReadWrite}})
        .pass("raycast", {{map, Use::kStorageRead}, {view, Use::kStorageWrite}})
        .pass("colourise", {{view, Use::kSampled}, {debug, Use::kStorageWrite}})
        .keep(map);
    const Plan plan = compile(frame.description());
    EXPECT_THAT(plan.order, ElementsAre(0));
    EXPECT_THAT(plan.culled, ElementsAre(1, 2));
    EXPECT_FALSE(plan.lifetimes[view]);
    EXPECT_FALSE(plan.placements[debug]);
    EXPECT_EQ(plan.image_arena, (MemoryNeed{0, 1}));
}

TEST(Compile, CullsTheProducerOfAVersionThatIsOnlyReplaced) {
    FrameBuilder frame;
    const uint32_t map = frame.import("map");
    frame.pass("fill", {{map, Use::kTransferWrite}}).pass("overwrite", {{map, Use::kStorageWrite}}).keep(map);
    const Plan plan = compile(frame.description());
    EXPECT_THAT(plan.order, ElementsAre(1));
    EXPECT_THAT(plan.culled, ElementsAre(0));
}

TEST(Compile, KeepsTheProducerOfAReplacedVersionThatALivePassReads) {
    FrameBuilder frame;
    const uint32_t map = frame.import("map");
    const uint32_t copy = frame.import("copy");
    frame.pass("fill", {{map, Use::kTransferWrite}})
        .pass("copy", {{map, Use::kTransferRead}, {copy, Use::kTransferWrite}})
        .pass("overwrite", {{map, Use::kStorageWrite}})
        .keep(map)
        .keep(copy);
    EXPECT_THAT(compile(frame.description()).order, ElementsAre(0, 1, 2));
}

TEST(Compile, KeepsTheProducerOfAVersionThatIsModified) {
    FrameBuilder frame;
    const uint32_t map = frame.import("map");
    frame.pass("fill", {{map, Use::kTransferWrite}}).pass("add", {{map, Use::kStorageReadWrite}}).keep(map);
    EXPECT_THAT(compile(frame.description()).order, ElementsAre(0, 1));
}

TEST(Compile, KeepsAnImportedResourceAsItWas) {
    FrameBuilder frame;
    const uint32_t map = frame.import("map");
    frame.keep(map).pass("write", {{map, Use::kStorageWrite}});
    EXPECT_THAT(compile(frame.description()).culled, ElementsAre(0));
}

TEST(Compile, OrdersTheFirstUseOfImportedResourcesByTheFrameBoundaryAlone) {
    FrameBuilder frame;
    const uint32_t arguments = frame.import("arguments");
    const uint32_t map = frame.import("map");
    frame.pass("dispatch", {{arguments, Use::kIndirect}, {map, Use::kStorageReadWrite}}).keep(map);
    EXPECT_THAT(compile(frame.description()).barriers,
                ElementsAre(Barrier{0, std::nullopt, kEarlierFrames, kIndirectReads | kStorageReadWrites, false}));
}

TEST(Compile, PutsOneBarrierBetweenAWriteAndAllItsReaders) {
    FrameBuilder frame;
    const uint32_t list = frame.import("list");
    const uint32_t a = frame.import("a");
    const uint32_t b = frame.import("b");
    frame.pass("fill", {{list, Use::kTransferWrite}})
        .pass("dispatch", {{list, Use::kIndirect}, {a, Use::kStorageWrite}})
        .pass("read", {{list, Use::kStorageRead}, {b, Use::kStorageWrite}})
        .pass("read again", {{list, Use::kStorageRead}, {a, Use::kStorageReadWrite}})
        .keep(a)
        .keep(b);
    const Scope all = kTransferWrites | kIndirectReads | kStorageReadWrites;
    EXPECT_THAT(compile(frame.description()).barriers,
                ElementsAre(Barrier{0, std::nullopt, kEarlierFrames, all, false},
                            Barrier{1, list, kTransferWrites, kIndirectReads | kStorageReads, false},
                            Barrier{3, a, kStorageWrites, kStorageReadWrites, false}));
}

TEST(Compile, MakesAWriteWaitForTheStagesOfAllReadersSinceTheLastWrite) {
    FrameBuilder frame;
    const uint32_t list = frame.import("list");
    const uint32_t copy = frame.import("copy");
    frame.pass("write", {{list, Use::kStorageWrite}})
        .pass("copy", {{list, Use::kTransferRead}, {copy, Use::kTransferWrite}})
        .pass("dispatch", {{list, Use::kIndirect}, {copy, Use::kStorageReadWrite}})
        .pass("modify", {{list, Use::kStorageReadWrite}})
        .pass("replace", {{list, Use::kTransferWrite}})
        .keep(list)
        .keep(copy);
    Plan plan = compile(frame.description());
    EXPECT_THAT(plan.culled, ElementsAre(3));
    const Scope readers{kStageTransfer | kStageIndirect, kAccessNone};
    plan.barriers.erase(plan.barriers.begin());
    EXPECT_THAT(plan.barriers, ElementsAre(Barrier{1, list, kStorageWrites, kTransferReads | kIndirectReads, false},
                                           Barrier{2, copy, kTransferWrites, kStorageReadWrites, false},
                                           Barrier{3, list, readers, kTransferWrites, false}));
}

TEST(Compile, OrdersAWriteBehindAWrite) {
    FrameBuilder frame;
    const uint32_t map = frame.import("map");
    frame.pass("clear", {{map, Use::kTransferWrite}})
        .pass("add", {{map, Use::kStorageReadWrite}})
        .pass("add more", {{map, Use::kStorageReadWrite}})
        .keep(map);
    Plan plan = compile(frame.description());
    plan.barriers.erase(plan.barriers.begin());
    EXPECT_THAT(plan.barriers, ElementsAre(Barrier{1, map, kTransferWrites, kStorageReadWrites, false},
                                           Barrier{2, map, kStorageWrites, kStorageReadWrites, false}));
}

TEST(Compile, OrdersAWriteBehindReadsOfWhatEarlierFramesLeft) {
    FrameBuilder frame;
    const uint32_t map = frame.import("map");
    const uint32_t out = frame.import("out");
    frame.pass("read", {{map, Use::kUniform}, {out, Use::kStorageWrite}})
        .pass("write", {{map, Use::kTransferWrite}})
        .keep(map)
        .keep(out);
    Plan plan = compile(frame.description());
    plan.barriers.erase(plan.barriers.begin());
    EXPECT_THAT(plan.barriers, ElementsAre(Barrier{1, map, kComputeStage, kTransferWrites, false}));
}

TEST(Compile, GivesATransientImageItsLayoutBeforeItsFirstUse) {
    FrameBuilder frame;
    const uint32_t depth = frame.image("depth", 64);
    const uint32_t normal = frame.image("normal", 64);
    const uint32_t map = frame.import("map");
    frame.pass("upload", {{depth, Use::kTransferWrite}})
        .pass("normals", {{depth, Use::kSampled}, {normal, Use::kStorageWrite}})
        .pass("integrate", {{normal, Use::kSampled}, {depth, Use::kSampled}, {map, Use::kStorageReadWrite}})
        .keep(map);
    const Scope all = kTransferWrites | kSampledReads | kStorageReadWrites;
    EXPECT_THAT(compile(frame.description()).barriers,
                ElementsAre(Barrier{0, std::nullopt, kEarlierFrames, all, false},
                            Barrier{0, depth, kEarlierFrames, kTransferWrites, true},
                            Barrier{1, depth, kTransferWrites, kSampledReads, false},
                            Barrier{1, normal, kComputeStage, kStorageWrites, true},
                            Barrier{2, normal, kStorageWrites, kSampledReads, false}));
}

/// a, b and c follow each other through the same memory; the pass `end` is the last reader of c.
Description make_chain(ResourceKind kind) {
    FrameBuilder frame;
    const auto add = [&](const char* name) {
        return kind == ResourceKind::kImage ? frame.image(name, 64, 16) : frame.buffer(name, 64, 16);
    };
    const uint32_t a = add("a");
    const uint32_t b = add("b");
    const uint32_t c = add("c");
    const uint32_t out = frame.import("out");
    frame.pass("make a", {{a, Use::kStorageWrite}})
        .pass("copy a", {{a, Use::kTransferRead}, {out, Use::kTransferWrite}})
        .pass("make b", {{b, Use::kStorageWrite}, {out, Use::kStorageReadWrite}})
        .pass("make c", {{c, Use::kTransferWrite}, {out, Use::kStorageReadWrite}})
        .pass("end", {{c, Use::kStorageRead}, {out, Use::kStorageReadWrite}})
        .keep(out);
    return frame.description();
}

std::vector<Barrier> on_transients(const Plan& plan) {
    std::vector<Barrier> found;
    for (const Barrier& barrier : plan.barriers) {
        if (barrier.resource && *barrier.resource < 3) found.push_back(barrier);
    }
    return found;
}

TEST(Compile, MakesABufferWaitForTheLastUsersOfItsMemory) {
    const Plan plan = compile(make_chain(ResourceKind::kBuffer));
    EXPECT_THAT(plan.placements, ElementsAre(Placement{0, 64}, Placement{0, 64}, Placement{0, 64}, std::nullopt));
    EXPECT_EQ(plan.buffer_arena, (MemoryNeed{64, 16}));
    EXPECT_THAT(on_transients(plan), ElementsAre(Barrier{1, 0, kStorageWrites, kTransferReads, false},
                                                 Barrier{2, 1, kTransferStage, kStorageWrites, false},
                                                 Barrier{3, 2, kStorageWrites, kTransferWrites, false},
                                                 Barrier{4, 2, kTransferWrites, kStorageReads, false}));
}

TEST(Compile, MakesAnImagesTransitionWaitForTheLastUsersOfItsMemory) {
    const Plan plan = compile(make_chain(ResourceKind::kImage));
    EXPECT_EQ(plan.image_arena, (MemoryNeed{64, 16}));
    EXPECT_THAT(on_transients(plan), ElementsAre(Barrier{0, 0, kEarlierFrames, kStorageWrites, true},
                                                 Barrier{1, 0, kStorageWrites, kTransferReads, false},
                                                 Barrier{2, 1, kTransferStage, kStorageWrites, true},
                                                 Barrier{3, 2, kStorageWrites, kTransferWrites, true},
                                                 Barrier{4, 2, kTransferWrites, kStorageReads, false}));
}

TEST(Compile, GivesBuffersAndImagesArenasOfTheirOwn) {
    FrameBuilder frame;
    const uint32_t buffer = frame.buffer("buffer", 10, 4);
    const uint32_t image = frame.image("image", 20, 8);
    const uint32_t out = frame.import("out");
    frame.pass("make buffer", {{buffer, Use::kStorageWrite}, {out, Use::kStorageWrite}})
        .pass("make image", {{image, Use::kStorageWrite}, {out, Use::kStorageReadWrite}})
        .keep(out);
    const Plan plan = compile(frame.description());
    EXPECT_THAT(plan.placements, ElementsAre(Placement{0, 10}, Placement{0, 20}, std::nullopt));
    EXPECT_EQ(plan.buffer_arena, (MemoryNeed{10, 4}));
    EXPECT_EQ(plan.image_arena, (MemoryNeed{20, 8}));
    EXPECT_THAT(plan.barriers, testing::Contains(Barrier{1, image, kComputeStage, kStorageWrites, true}));
}

TEST(Compile, LetsAKeptTransientLiveToTheEndOfTheFrame) {
    FrameBuilder frame;
    const uint32_t kept = frame.buffer("kept", 64);
    const uint32_t later = frame.buffer("later", 64);
    const uint32_t out = frame.import("out");
    frame.pass("make kept", {{kept, Use::kStorageWrite}})
        .pass("make later", {{later, Use::kStorageWrite}})
        .pass("end", {{later, Use::kStorageRead}, {out, Use::kStorageWrite}})
        .keep(kept)
        .keep(out);
    const Plan plan = compile(frame.description());
    EXPECT_THAT(plan.lifetimes, ElementsAre(Lifetime{0, 2}, Lifetime{1, 2}, Lifetime{2, 2}));
    EXPECT_THAT(plan.placements, ElementsAre(Placement{0, 64}, Placement{64, 64}, std::nullopt));
}

}  // namespace
}  // namespace patina::graph::compile_test
