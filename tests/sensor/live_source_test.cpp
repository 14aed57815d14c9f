#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

#include <gmock/gmock.h>

#include "engine/core/error.h"
#include "sensor/ledger.h"
#include "sensor/live/played_source.h"
#include "tests/sensor/sequences.h"

// What a live source yields to a consumer that is late: the newest frame, and word of the others.

namespace patina::sensor::live_source_test {
namespace {

using namespace testing;

uint32_t index_of(const Reading& reading) {
    const auto* frame = std::get_if<Frame>(&reading);
    return frame ? frame->index : std::get<Skipped>(reading).index;
}

bool dropped(const Reading& reading) {
    const auto* skipped = std::get_if<Skipped>(&reading);
    return skipped && skipped->dropped;
}

TEST(NewestFrame, TheNewestWinsAndTheOthersAreCounted) {
    NewestFrame newest;
    for (uint32_t i = 0; i < 3; ++i) newest.put(test_frame(i, {32, 24}, {16, 12}));
    newest.put(Skipped{3, "a packet was lost"});
    newest.end();
    std::vector<Reading> readings;
    while (auto reading = newest.take()) readings.push_back(*std::move(reading));
    ASSERT_EQ(readings.size(), 4u);
    for (uint32_t i = 0; i < 4; ++i) EXPECT_EQ(index_of(readings[i]), i);
    EXPECT_TRUE(dropped(readings[0]) && dropped(readings[1]) && dropped(readings[2]));
    EXPECT_FALSE(dropped(readings[3]));  // damaged, not dropped
    const LiveCounts counts = newest.counts();
    EXPECT_EQ(counts.captured, 4u);
    EXPECT_EQ(counts.dropped, 3u);
    EXPECT_EQ(counts.damaged, 1u);
    EXPECT_EQ(counts.delivered, 0u);
}

TEST(NewestFrame, APromptConsumerGetsAll) {
    NewestFrame newest;
    for (uint32_t i = 0; i < 3; ++i) {
        newest.put(test_frame(i, {32, 24}, {16, 12}));
        EXPECT_EQ(std::get<Frame>(*newest.take()).index, i);
    }
    EXPECT_EQ(newest.counts().dropped, 0u);
}

TEST(NewestFrame, AFailureComesAfterWhatWaits) {
    NewestFrame newest;
    newest.put(test_frame(0, {32, 24}, {16, 12}));
    newest.end(std::make_exception_ptr(Error("the camera is gone")));
    EXPECT_EQ(std::get<Frame>(*newest.take()).index, 0u);
    EXPECT_EQ(error_of([&] { newest.take(); }), "the camera is gone");
}

TEST(WaitingSkips, KeepEachReasonWhileFewWait) {
    WaitingSkips waiting;
    for (uint32_t i = 0; i < 10000; ++i) waiting.push({i, "dropped", true});  // one entry
    waiting.push({10000, "a packet was lost"});
    waiting.push({10001, "dropped", true});
    for (uint32_t i = 0; i < 10002; ++i) {
        const auto skipped = waiting.pop();
        ASSERT_TRUE(skipped);
        EXPECT_EQ(skipped->index, i);
        EXPECT_EQ(skipped->dropped, i != 10000);
        EXPECT_EQ(skipped->reason, i == 10000 ? "a packet was lost" : "dropped");
    }
    EXPECT_TRUE(waiting.empty());
}

TEST(WaitingSkips, OfTooManyTheNumbersAreKeptAndNoReason) {
    constexpr uint32_t kFirst = 5, kFrames = 3 * WaitingSkips::kMostEntries;
    WaitingSkips waiting;
    for (uint32_t i = 0; i < kFrames; ++i)
        waiting.push({kFirst + i, i % 3 == 0 ? "dropped" : text("reason ", i), i % 3 == 0});
    uint32_t dropped = 0, with_reason = 0;
    for (uint32_t i = 0; i < kFrames; ++i) {
        const auto skipped = waiting.pop();
        ASSERT_TRUE(skipped);
        EXPECT_EQ(skipped->index, kFirst + i);
        dropped += skipped->dropped;
        with_reason += skipped->reason == text("reason ", i);
        EXPECT_EQ(skipped->reason == "dropped", skipped->dropped);
        if (i == WaitingSkips::kMostEntries) {
            EXPECT_EQ(skipped->reason,
                      "damaged, as others of the frames 69 to 196 were: too many waited to keep each one's reason");
        }
    }
    EXPECT_EQ(dropped, kFrames / 3);
    EXPECT_EQ(with_reason, WaitingSkips::kMostEntries - (WaitingSkips::kMostEntries + 2) / 3) << "damaged ones";
    EXPECT_FALSE(waiting.pop());
    waiting.push({kFirst + kFrames, "a reason"});  // there is room again
    EXPECT_EQ(waiting.pop()->reason, "a reason");
}

TEST(WaitingSkips, WhatComesWhileTooManyWaitKeepsItsPlace) {
    WaitingSkips waiting;
    for (uint32_t i = 0; i <= WaitingSkips::kMostEntries; ++i) waiting.push({i, "a reason"});
    for (uint32_t i = 0; i < 10; ++i) EXPECT_EQ(waiting.pop()->index, i);
    waiting.push({WaitingSkips::kMostEntries + 1, "a reason"});
    for (uint32_t i = 10; i <= WaitingSkips::kMostEntries + 1; ++i) EXPECT_EQ(waiting.pop()->index, i);
    EXPECT_TRUE(waiting.empty());
}

std::unique_ptr<Source> recording_of(uint32_t frames, double fps) {
    std::vector<Reading> readings = test_readings(frames);
    for (Reading& reading : readings) {
        auto& frame = std::get<Frame>(reading);
        frame.timestamp_s = 100 + frame.index / fps;
    }
    return std::make_unique<MemorySource>(test_info(), std::move(readings));
}

TEST(PlayedSource, KeepsTheRecordingsTime) {
    PlayedSource source(recording_of(10, 100));
    EXPECT_FALSE(source.info().frames.has_value());
    const auto start = std::chrono::steady_clock::now();
    double earliest_s = 1e9;
    while (const auto reading = source.next()) {
        // No frame is there before it was exposed.
        if (const auto* frame = std::get_if<Frame>(&*reading))
            earliest_s = std::min(earliest_s, source.now_s() - frame->timestamp_s);
    }
    EXPECT_GE(earliest_s, 0);
    const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_GE(took_s, 0.09);  // nine intervals of 10 ms
}

TEST(PlayedSource, ALateConsumerMissesFramesAndTheTapNone) {
    std::vector<uint32_t> tapped;
    PlayedSource source(recording_of(60, 200), [&](const Reading& reading) { tapped.push_back(index_of(reading)); });
    Ledger ledger;
    uint32_t expected = 0;
    while (const auto reading = source.next()) {
        EXPECT_EQ(index_of(*reading), expected++);  // all indices, in order
        ledger.note(*reading);
        if (!std::holds_alternative<Frame>(*reading)) continue;
        ledger.use(index_of(*reading));
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    const LiveCounts counts = source.counts();
    EXPECT_EQ(counts.captured, 60u);
    EXPECT_EQ(counts.captured, counts.delivered + counts.dropped);
    EXPECT_GT(counts.dropped, 20u);  // three of four, were the consumer alone with its machine
    EXPECT_EQ(ledger.dropped(), counts.dropped);
    EXPECT_EQ(ledger.used(), counts.delivered);
    EXPECT_EQ(ledger.discrepancy(source.info()), std::nullopt);
    EXPECT_EQ(tapped.size(), 60u);
}

std::chrono::steady_clock::time_point now() { return std::chrono::steady_clock::now(); }

TEST(PlayedSource, AnHourBetweenTwoFramesIsNotWaitedFor) {
    PlayedSource source(recording_of(2, 1 / 3600.0));
    ASSERT_TRUE(source.next());
    const auto start = now();
    const auto second = source.next();
    ASSERT_TRUE(second);
    EXPECT_GE(source.now_s(), std::get<Frame>(*second).timestamp_s);
    EXPECT_LT(source.now_s(), std::get<Frame>(*second).timestamp_s + 60);
    EXPECT_LT(now() - start, std::chrono::minutes(1));
    EXPECT_FALSE(source.next());
}

TEST(PlayedSource, TheTapIsNotCalledOnceItIsStopped) {
    std::atomic<bool> stopped = false;
    std::atomic<int> late = 0;
    PlayedSource source(recording_of(500, 1000), [&](const Reading&) { late += stopped; });
    ASSERT_TRUE(source.next());
    source.stop();
    stopped = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_EQ(late, 0);
}

TEST(PlayedSource, StopEndsAWait) {
    PlayedSource source(recording_of(2, 0.001));  // the second frame comes after Player<Frame>::kLongestGap_s
    ASSERT_TRUE(source.next());
    const auto start = now();
    std::jthread stopper([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        source.stop();
    });
    EXPECT_FALSE(source.next());
    EXPECT_LT(now() - start, std::chrono::duration<double>(Player<Frame>::kLongestGap_s));
}

}  // namespace
}  // namespace patina::sensor::live_source_test
