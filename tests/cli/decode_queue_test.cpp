#include "tools/record/decode_queue.h"

#include <future>

#include <gmock/gmock.h>

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
