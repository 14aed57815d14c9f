#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "sensor/live/live_source.h"
#include "sensor/live/newest_frame.h"

namespace patina::sensor {

/// A recording that plays as a camera would: each frame comes at the time that its timestamp says after the first one.
/// What cannot be decoded by then comes late. A gap between two timestamps is played as kLongestGap_s at most. Indices
/// and timestamps are the recording's.
class PlayedSource : public LiveSource {
  public:
    static constexpr double kLongestGap_s = 2;

    /// Begins to play when it is first asked for a reading. `tap` may be empty.
    explicit PlayedSource(std::unique_ptr<Source> recording, ReadingTap tap = {});
    ~PlayedSource() override;

    const SequenceInfo& info() const override { return info_; }
    std::optional<Reading> next() override;
    /// Once this returns, the tap is not called any more.
    void stop() override;
    double now_s() const override;
    LiveCounts counts() const override { return newest_.counts(); }

  private:
    using Clock = std::chrono::steady_clock;
    /// A moment on both clocks.
    struct Moment {
        double timestamp_s = 0;
        Clock::time_point at{};
    };
    void play();
    Moment due(double timestamp_s);
    bool wait_for(double timestamp_s);
    bool hand_over(Reading reading);

    std::unique_ptr<Source> recording_;
    ReadingTap tap_;
    SequenceInfo info_;
    NewestFrame newest_;
    std::mutex mutex_;  ///< held while the tap runs
    std::condition_variable changed_;
    bool stopped_ = false;  ///< of mutex_
    mutable std::mutex clock_mutex_;
    std::optional<Moment> last_;  ///< of clock_mutex_: the exposure of the last frame, or of the one that is waited for
    std::jthread thread_;         // last: joins before what it uses is destroyed
};

}  // namespace patina::sensor
