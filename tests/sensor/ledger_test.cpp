#include "sensor/ledger.h"

#include <gmock/gmock.h>

#include "tests/sensor/sequences.h"

namespace patina::sensor::ledger_test {
namespace {

using namespace testing;

SequenceInfo four_frames() {
    SequenceInfo info = test_info();
    info.frames = 4;
    return info;
}

Ledger with_frames_0_to(uint32_t count) {
    Ledger ledger;
    for (uint32_t i = 0; i < count; ++i) {
        Frame frame;
        frame.index = i;
        ledger.note(frame);
    }
    return ledger;
}

TEST(Ledger, FramesThatRepeatOthersAreCountedAlone) {
    Ledger ledger = with_frames_0_to(4);
    for (uint32_t i = 0; i < 3; ++i) ledger.use(i);
    EXPECT_NE(ledger.discrepancy(four_frames()), std::nullopt);
    ledger.repeat(3);
    EXPECT_EQ(ledger.discrepancy(four_frames()), std::nullopt);
    EXPECT_EQ(ledger.repeated(), 1u);
    EXPECT_TRUE(ledger.skipped().empty());
}

TEST(Ledger, WhatIsUndoneAddsUpToo) {
    Ledger ledger = with_frames_0_to(4);
    for (uint32_t i = 0; i < 4; ++i) ledger.use(i);
    ledger.undo(3);
    EXPECT_EQ(ledger.used(), 1u);
    EXPECT_EQ(ledger.undone(), 3u);
    EXPECT_EQ(ledger.discrepancy(four_frames()), std::nullopt);
}

TEST(Ledger, AddsUp) {
    Ledger ledger = with_frames_0_to(3);
    ledger.note(Skipped{3, "c.png is truncated"});
    ledger.use(0);
    ledger.use(2);
    ledger.skip(1, "tracking was lost");
    EXPECT_EQ(ledger.discrepancy(four_frames()), std::nullopt);
    EXPECT_EQ(ledger.read(), 4u);
    EXPECT_EQ(ledger.used(), 2u);
    ASSERT_EQ(ledger.skipped().size(), 2u);
    EXPECT_EQ(ledger.skipped()[0].reason, "c.png is truncated");
    EXPECT_EQ(ledger.skipped()[1].index, 1u);
}

TEST(Ledger, SaysByHowMuchItDoesNot) {
    Ledger ledger = with_frames_0_to(2);
    EXPECT_EQ(ledger.discrepancy(four_frames()), "test has 4 frames, but 2 were read: 2 missing");
    ledger = with_frames_0_to(5);
    EXPECT_EQ(ledger.discrepancy(four_frames()), "test has 4 frames, but 5 were read: 1 too many");
    ledger = with_frames_0_to(4);
    ledger.use(0);
    ledger.skip(1, "x");
    EXPECT_EQ(ledger.discrepancy(four_frames()),
              "test: 4 frames were read, but 1 used and 1 left out: 2 unaccounted for");
    for (const uint32_t index : {0, 2, 3}) ledger.use(index);
    EXPECT_EQ(ledger.discrepancy(four_frames()), "test: 4 frames were read, but 4 used and 1 left out: 1 too many");
}

TEST(Ledger, NoticesThatOneFrameStandsInForAnother) {
    Ledger ledger = with_frames_0_to(4);
    for (const uint32_t index : {0, 1, 1, 3}) ledger.use(index);
    EXPECT_EQ(ledger.discrepancy(four_frames()), "test: frame 1 was used or skipped 2 times instead of once");
}

TEST(Ledger, OfASourceWithoutALengthWhatWasReadIsAll) {
    SequenceInfo live = test_info();
    live.frames.reset();
    Ledger ledger = with_frames_0_to(3);
    for (uint32_t i = 0; i < 3; ++i) ledger.use(i);
    EXPECT_EQ(ledger.discrepancy(live), std::nullopt);
    ledger.use(1);
    EXPECT_NE(ledger.discrepancy(live), std::nullopt);
}

}  // namespace
}  // namespace patina::sensor::ledger_test
