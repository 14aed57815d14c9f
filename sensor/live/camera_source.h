#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "sensor/live/live_source.h"
#include "sensor/live/newest_frame.h"
#include "sensor/live/picture_camera.h"

namespace patina::sensor {

/// A camera of another library as a live source: a thread of its own takes the pictures and pairs them.
class CameraSource : public LiveSource {
  public:
    /// Depth and colour of one frame are at most so far apart: half of the time between two frames at 30 a second, and
    /// a little more for the clock's jitter.
    static constexpr double kMostApart_s = 0.018;

    explicit CameraSource(std::unique_ptr<PictureCamera> camera);
    ~CameraSource() override;

    /// To be called before the first next(), with which the camera starts.
    void set_tap(ReadingTap tap) { tap_ = std::move(tap); }

    const SequenceInfo& info() const override { return camera_->info(); }
    /// Throws Error where the camera fails or is unplugged, after the frames that came before.
    std::optional<Reading> next() override;
    /// Once this returns, the tap is not called any more. A camera that has not started does not start any more.
    void stop() override;
    /// The camera's clock is known by its pictures alone: the frame that came soonest after its time counts as without
    /// delay. 0 before the first frame.
    double now_s() const override;
    LiveCounts counts() const override { return newest_.counts(); }

  private:
    using Clock = std::chrono::steady_clock;
    void run(const std::stop_token& stop);
    void note_time(double timestamp_s);
    void hand_over(Reading reading);

    std::unique_ptr<PictureCamera> camera_;
    ReadingTap tap_;
    NewestFrame newest_;
    uint32_t frames_ = 0;   ///< of the camera's thread
    std::mutex tap_mutex_;  ///< held while the tap runs
    bool stopped_ = false;  ///< of tap_mutex_
    mutable std::mutex clock_mutex_;
    std::optional<Clock::time_point> origin_;  ///< of clock_mutex_: when the camera's clock was at 0, at the latest
    std::stop_source stop_;
    std::jthread thread_;  // of next(); last: joins before what it uses is destroyed
};

}  // namespace patina::sensor
