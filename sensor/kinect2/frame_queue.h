#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <vector>

#include "sensor/kinect2/raw_frame.h"

namespace patina::sensor::kinect2 {

/// Frames on their way from the driver's thread to the one that uses them. It holds a few; when it is full, the oldest
/// goes and is counted, so that the newest is always there. Buffers circulate instead of being allocated.
class FrameQueue {
  public:
    explicit FrameQueue(size_t capacity) : capacity_(capacity) {}

    /// Adds a frame; returns one whose buffers can be filled.
    RawFrame push(RawFrame frame);
    /// No more frames come; pop() throws `failure` once it has returned those that are there.
    void close(std::exception_ptr failure);
    /// Ends a pop() that waits, and all further ones, at once.
    void interrupt();

    enum class Result { kFrame, kNothing, kInterrupted };
    /// Exchanges the oldest frame with `frame`, whose buffers are reused; waits for it as long as `patience`. Throws
    /// what closed the queue.
    Result pop(RawFrame& frame, std::chrono::milliseconds patience);

    /// Throws away the frames that wait; they do not count as dropped.
    void forget();

    uint64_t dropped() const;

  private:
    const size_t capacity_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<RawFrame> frames_;
    std::vector<RawFrame> spare_;
    std::exception_ptr failure_;
    bool interrupted_ = false;
    uint64_t dropped_ = 0;
};

}  // namespace patina::sensor::kinect2
