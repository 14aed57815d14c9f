#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include "sensor/live/live_source.h"
#include "sensor/live/newest_frame.h"

namespace patina::sensor {

/// A recording that plays as a camera would: each frame comes at the time that its timestamp says after the first one.
/// What cannot be decoded by then comes late. Indices and timestamps are the recording's.
class PlayedSource : public LiveSource {
  public:
    /// Begins to play when it is first asked for a reading. `tap` may be empty.
    explicit PlayedSource(std::unique_ptr<Source> recording, ReadingTap tap = {});
    ~PlayedSource() override;

    const SequenceInfo& info() const override { return info_; }
    std::optional<Reading> next() override;
    void stop() override;
    double now_s() const override;
    LiveCounts counts() const override { return newest_.counts(); }

  private:
    using Clock = std::chrono::steady_clock;
    void play(std::stop_token stop);
    void wait_for(double timestamp_s, std::stop_token stop);

    std::unique_ptr<Source> recording_;
    ReadingTap tap_;
    SequenceInfo info_;
    NewestFrame newest_;
    Clock::time_point start_;              ///< of the first frame's exposure
    std::atomic<double> first_s_ = 0;      ///< its timestamp
    std::atomic<bool> has_first_ = false;  ///< whether there was one
    std::atomic<bool> stopped_ = false;
    std::jthread thread_;  // last: stops and joins before what it uses is destroyed
};

}  // namespace patina::sensor
