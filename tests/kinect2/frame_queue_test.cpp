#include "sensor/kinect2/frame_queue.h"

#include <thread>

#include <gtest/gtest.h>

#include "engine/core/error.h"

namespace patina::sensor::kinect2::testing::frame_queue_test {
namespace {

using namespace std::chrono_literals;

RawFrame frame(uint32_t sequence) {
    RawFrame raw;
    raw.sequence = sequence;
    return raw;
}

TEST(Kinect2Queue, NewestWinsAndDropsAreCounted) {
    FrameQueue queue(2);
    for (uint32_t n = 0; n < 5; ++n) queue.push(frame(n));
    EXPECT_EQ(queue.dropped(), 3u);
    RawFrame raw;
    ASSERT_EQ(queue.pop(raw, 0ms), FrameQueue::Result::kFrame);
    EXPECT_EQ(raw.sequence, 3u);
    ASSERT_EQ(queue.pop(raw, 0ms), FrameQueue::Result::kFrame);
    EXPECT_EQ(raw.sequence, 4u);
    EXPECT_EQ(queue.pop(raw, 0ms), FrameQueue::Result::kNothing);
}

TEST(Kinect2Queue, ForgottenFramesDoNotComeAndAreNotDropped) {
    FrameQueue queue(2);
    queue.push(frame(1));
    queue.forget();
    queue.push(frame(2));
    EXPECT_EQ(queue.dropped(), 0u);
    RawFrame raw;
    ASSERT_EQ(queue.pop(raw, 0ms), FrameQueue::Result::kFrame);
    EXPECT_EQ(raw.sequence, 2u);
}

TEST(Kinect2Queue, FailureComesAfterTheFramesBeforeIt) {
    FrameQueue queue(2);
    queue.push(frame(7));
    queue.close(std::make_exception_ptr(Error("gone")));
    RawFrame raw;
    ASSERT_EQ(queue.pop(raw, 0ms), FrameQueue::Result::kFrame);
    EXPECT_THROW(queue.pop(raw, 1h), Error);
    EXPECT_THROW(queue.pop(raw, 1h), Error) << "and stays";
}

TEST(Kinect2Queue, InterruptEndsAWait) {
    FrameQueue queue(2);
    std::thread other([&] {
        std::this_thread::sleep_for(20ms);
        queue.interrupt();
    });
    RawFrame raw;
    EXPECT_EQ(queue.pop(raw, 1h), FrameQueue::Result::kInterrupted);
    other.join();
}

TEST(Kinect2Queue, BuffersCirculate) {
    FrameQueue queue(2);
    RawFrame fetched = frame(0);
    fetched.infrared.resize(1000);
    const uint8_t* const bytes = fetched.infrared.data();
    queue.push(frame(1));
    ASSERT_EQ(queue.pop(fetched, 0ms), FrameQueue::Result::kFrame);
    EXPECT_EQ(queue.push(frame(2)).infrared.data(), bytes);
}

}  // namespace
}  // namespace patina::sensor::kinect2::testing::frame_queue_test
