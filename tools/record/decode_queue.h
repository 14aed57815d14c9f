#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "cameras/raw_capture.h"
#include "sensor/live/waiting_skips.h"

namespace patina::tools {

/// Decodes a camera's frames on a thread of its own, one after the other, and hands each on. The camera does not wait:
/// a frame that finds the queue full is dropped, and handed on as such. Its memory is bounded by `most_bytes`, however
/// many frames are dropped: beside a frame that waits there are sensor::WaitingSkips at most.
class DecodeQueue {
  public:
    /// What becomes of a frame; may wait for the device. Throws Error where nothing more can be decoded.
    using Decode = std::function<cameras::RawReading(const sensor::RecordedFrame&)>;
    using HandOn = std::function<void(cameras::RawReading)>;

    /// Two and a half seconds of a Kinect v2.
    static constexpr uint64_t kMostBytes = uint64_t{256} << 20;

    /// Both functions are called on the queue's thread, which is the only one that uses what they do.
    DecodeQueue(Decode decode, HandOn hand_on, uint64_t most_bytes = kMostBytes);

    /// For one thread at a time, the camera's. Once nothing more can be decoded, nothing happens. Indices rise by one.
    void put(const cameras::RawReading& reading);

    /// Waits until all that was put has been handed on. Throws Error with why that ended; the frames that waited then
    /// are lost.
    void drain();

    uint64_t dropped() const;
    /// Why nothing more can be decoded; empty while it can.
    std::string problem() const;

  private:
    /// A frame, and what was skipped after it. It stays until both have been handed on.
    struct Entry {
        std::optional<sensor::RecordedFrame> frame;
        sensor::WaitingSkips skipped;
    };

    bool reserve(uint64_t bytes);
    void put_frame(const sensor::RecordedFrame& frame);
    void put_skipped(const Skipped& skipped);
    std::optional<cameras::RawReading> take();
    std::string process(cameras::RawReading reading) const;
    void run(const std::stop_token& stop);

    Decode decode_;
    HandOn hand_on_;
    uint64_t most_bytes_;
    mutable std::mutex mutex_;
    std::condition_variable_any changed_;
    std::deque<Entry> waiting_;  ///< the first one's frame may be with the decoder
    uint64_t bytes_ = 0;         ///< of frames that wait, that are copied, and of the one that is decoded
    uint64_t dropped_ = 0;
    std::string problem_;
    std::jthread thread_;  // last: joins before what it uses is destroyed
};

}  // namespace patina::tools
