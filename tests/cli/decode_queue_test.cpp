#include "tools/record/decode_queue.h"

#include <fstream>
#include <future>

#include <gmock/gmock.h>
#include <unistd.h>

#include "engine/core/error.h"

// A camera's frames on their way through a decoder that is slower than the camera, or fails.

namespace patina::tools::decode_queue_test {
namespace {

using cameras::RawReading;

RawReading frame_of(uint32_t index, size_t bytes) {
    sensor::RecordedFrame frame;
    frame.index = index;
    frame.payloads.push_back({0, 0, 0, "", std::vector<uint8_t>(bytes)});
    return frame;
}

uint64_t resident_bytes() {
    uint64_t pages = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> pages >> resident;
    return resident * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
}

TEST(DecodeQueue, WhatDoesNotFitIsDroppedInItsPlace) {
    std::promise<void> go_on;
    const std::shared_future<void> may_go_on = go_on.get_future().share();
    std::vector<std::string> handed;
    DecodeQueue queue(
        [&](const sensor::RecordedFrame& frame) -> RawReading {
            may_go_on.wait();
            if (frame.index == 1) return Skipped{1, "damaged"};
            return frame;
        },
        [&](const RawReading& reading) {
            const auto* skipped = std::get_if<Skipped>(&reading);
            handed.push_back(!skipped ? "frame" : skipped->dropped ? "dropped" : "damaged");
        },
        350);
    for (uint32_t i = 0; i < 5; ++i) queue.put(frame_of(i, 100));
    queue.put(Skipped{5, "lost"});
    go_on.set_value();
    queue.drain();
    EXPECT_THAT(handed, ::testing::ElementsAre("frame", "damaged", "frame", "dropped", "dropped", "damaged"));
    EXPECT_EQ(queue.dropped(), 2u);
    queue.put(frame_of(6, 1000));  // one fits always
    queue.drain();
    EXPECT_EQ(handed.back(), "frame");
}

/// A decoder that stands still for two hours: a camera sends 216 000 frames meanwhile.
TEST(DecodeQueue, ItsMemoryIsBoundedHoweverManyFramesAreDropped) {
    constexpr uint32_t kFrames = 200000, kEnd = 1000;
    // An entry for each dropped frame takes 70 MiB; a sanitizer keeps 16 MiB of freed memory, and what describes it.
    constexpr uint64_t kMost = uint64_t{40} << 20;
    std::promise<void> go_on;
    const std::shared_future<void> may_go_on = go_on.get_future().share();
    uint32_t next = 0, dropped = 0, decoded = 0, lost = 0, with_reason = 0;
    DecodeQueue queue(
        [&](const sensor::RecordedFrame& frame) -> RawReading {
            may_go_on.wait();
            return frame;
        },
        [&](const RawReading& reading) {
            const auto* skipped = std::get_if<Skipped>(&reading);
            EXPECT_EQ(skipped ? skipped->index : std::get<sensor::RecordedFrame>(reading).index, next);
            ++next;
            dropped += skipped && skipped->dropped;
            lost += skipped && !skipped->dropped;
            with_reason += skipped && skipped->reason == "a packet was lost";
            decoded += !skipped;
        },
        350);
    RawReading frame = frame_of(0, 100);
    const uint64_t before = resident_bytes();
    for (uint32_t i = 0; i < kFrames; ++i) {
        std::get<sensor::RecordedFrame>(frame).index = i;
        queue.put(frame);
    }
    // Then every second one has lost a packet.
    for (uint32_t i = kFrames; i < kFrames + kEnd; ++i) {
        std::get<sensor::RecordedFrame>(frame).index = i;
        if (i % 2 == 0) {
            queue.put(Skipped{i, "a packet was lost"});
        } else {
            queue.put(frame);
        }
    }
    EXPECT_LT(resident_bytes(), before + kMost);
    go_on.set_value();
    queue.drain();
    EXPECT_EQ(next, kFrames + kEnd);
    EXPECT_EQ(decoded, 3u);
    EXPECT_EQ(dropped, queue.dropped());
    EXPECT_EQ(lost, kEnd / 2);
    EXPECT_EQ(decoded + dropped + lost, next);
    EXPECT_LT(with_reason, kEnd / 4) << "of many, the reasons are not kept";
}

TEST(DecodeQueue, AFailureEndsIt) {
    int handed = 0;
    DecodeQueue queue([](const sensor::RecordedFrame&) -> RawReading { throw Error("the device was lost"); },
                      [&](const RawReading&) { ++handed; });
    for (uint32_t i = 0; i < 5; ++i) queue.put(frame_of(i, 100));
    EXPECT_THROW(queue.drain(), Error);
    EXPECT_EQ(queue.problem(), "the device was lost");
    queue.put(frame_of(5, 100));
    EXPECT_EQ(handed, 0);
}

}  // namespace
}  // namespace patina::tools::decode_queue_test
