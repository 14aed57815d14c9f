#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "engine/graph/plan/plan.h"
#include "tests/graph/frame_builder.h"

namespace patina::graph::wiring_test {
namespace {

/// The message with which compile() refuses a frame of an imported 'map' (0) and a transient 'list' (1).
std::string refusal(const std::vector<Pass>& passes, const std::vector<Keep>& kept = {}) {
    FrameBuilder frame;
    frame.import("map");
    frame.buffer("list", 16);
    Description description = frame.description();
    description.passes = passes;
    description.kept = kept;
    try {
        compile(description);
    } catch (const Error& error) {
        return error.what();
    }
    return "accepted";
}

const Pass kWriteMap{"integrate", {{0, 0, Use::kStorageWrite}}};

TEST(Wiring, AcceptsEachVersionInTurn) {
    EXPECT_EQ(refusal({kWriteMap, {"add", {{0, 1, Use::kStorageReadWrite}, {1, 0, Use::kStorageWrite}}}}, {{0, 2}}),
              "accepted");
}

TEST(Wiring, RefusesAVersionReadBeforeItWasWritten) {
    EXPECT_EQ(refusal({{"raycast", {{0, 1, Use::kStorageRead}}}, kWriteMap}),
              "pass 'raycast' reads version 1 of 'map' before it was written: its current version is 0");
    EXPECT_EQ(refusal({{"clear", {{0, 2, Use::kTransferWrite}}}}),
              "pass 'clear' replaces version 2 of 'map' before it was written: its current version is 0");
}

TEST(Wiring, RefusesAVersionWrittenTwice) {
    EXPECT_EQ(refusal({kWriteMap, {"clear", {{0, 0, Use::kTransferWrite}}}}),
              "pass 'clear' replaces version 0 of 'map', which is stale: its current version is 1");
    EXPECT_EQ(refusal({kWriteMap, {"add", {{0, 0, Use::kStorageReadWrite}}}}),
              "pass 'add' reads version 0 of 'map', which is stale: its current version is 1");
}

TEST(Wiring, RefusesAReadOfAReplacedVersion) {
    EXPECT_EQ(refusal({kWriteMap, {"raycast", {{0, 0, Use::kStorageRead}}}}),
              "pass 'raycast' reads version 0 of 'map', which is stale: its current version is 1");
}

TEST(Wiring, RefusesAReadOfAnUndefinedTransient) {
    const std::string rest =
        " version 0 of transient resource 'list', which is undefined: its first written version is 1";
    EXPECT_EQ(refusal({{"count", {{1, 0, Use::kStorageRead}}}}), "pass 'count' reads" + rest);
    EXPECT_EQ(refusal({{"append", {{1, 0, Use::kStorageReadWrite}}}}), "pass 'append' reads" + rest);
}

TEST(Wiring, RefusesTwoAccessesOfOneResourceInOnePass) {
    EXPECT_EQ(refusal({{"blur", {{0, 0, Use::kSampled}, {1, 0, Use::kStorageWrite}, {0, 0, Use::kStorageWrite}}}}),
              "pass 'blur' uses 'map' twice, in its accesses 0 and 2");
}

TEST(Wiring, RefusesAnUnknownResource) {
    EXPECT_EQ(refusal({{"blur", {{7, 0, Use::kSampled}}}}), "pass 'blur' uses resource 7, but the frame has 2");
    EXPECT_EQ(refusal({}, {{2, 0}}), "resource 2 is kept, but the frame has 2");
}

TEST(Wiring, RefusesAKeptVersionThatNoPassMade) {
    EXPECT_EQ(refusal({kWriteMap}, {{0, 2}}), "version 2 of 'map' is kept, but its last written version is 1");
    EXPECT_EQ(refusal({kWriteMap}, {{1, 0}}),
              "version 0 of transient resource 'list' is kept, but it is undefined: its first written version is 1");
}

TEST(Wiring, RefusesAKeptVersionThatALivePassReplaces) {
    const Pass add{"add", {{0, 1, Use::kStorageReadWrite}}};
    EXPECT_EQ(refusal({kWriteMap, add}, {{0, 1}, {0, 2}}),
              "version 1 of 'map' is kept, but pass 'add' replaces it by version 2");
    EXPECT_EQ(refusal({kWriteMap, add}, {{0, 1}}), "accepted") << "'add' is culled";
}

TEST(Wiring, ChecksCulledPassesToo) {
    EXPECT_EQ(refusal({kWriteMap, {"unused", {{0, 5, Use::kStorageRead}}}}, {{0, 1}}),
              "pass 'unused' reads version 5 of 'map' before it was written: its current version is 1");
}

TEST(Wiring, RefusesATransientThatAsksForNoMemory) {
    FrameBuilder frame;
    frame.buffer("list", 0, 4);
    try {
        compile(frame.description());
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(),
                     "transient resource 'list' asks for 0 bytes at alignment 4; both must be at least 1");
    }
}

}  // namespace
}  // namespace patina::graph::wiring_test
