#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "cameras/kinect2_recorded.h"
#include "cameras/raw_capture.h"
#include "sensor/kinect2/device.h"
#include "sensor/live/newest_frame.h"

namespace patina::cameras {

/// A Kinect v2 that runs: a thread takes its raw frames as they come. The newest one waits to be asked for; the tap
/// sees all. Nothing is decoded.
class Kinect2Capture : public RawCapture {
  public:
    /// Starts the device. Throws Error as sensor::kinect2::Device.
    explicit Kinect2Capture(std::unique_ptr<sensor::kinect2::Transport> transport);
    ~Kinect2Capture() override;

    const sensor::RecordedSequence& sequence() const override { return sequence_; }
    /// "Kinect v2 at 2-1".
    const std::string& name() const override { return device_.name(); }
    /// What works less well than it should; empty: nothing.
    std::string warning() const { return device_.warning(); }

    /// Fixes the exposure, and the white balance as it is. From any thread. Throws as sensor::kinect2::Device.
    void fix_exposure(const sensor::kinect2::ManualExposure& exposure);

    void set_tap(Tap tap) override { tap_ = std::move(tap); }

    /// Throws Error where the device fails or is unplugged.
    std::optional<RawReading> next() override;

    void stop() override;

    /// The device's clock is known by its frames alone: the one that came soonest after its time stamp counts as
    /// without delay. So latencies lack what the quickest frame took from its exposure to the host. 0 before the first
    /// frame.
    double now_s() const override;

    /// Lost is an infrared frame of which a packet did not arrive, that has no picture, or that the tap was too slow
    /// for; from the first next() on, as nobody wants those before.
    sensor::LiveCounts counts() const override;

  private:
    using Clock = std::chrono::steady_clock;
    void run();
    void note_time(double timestamp_s);
    bool hand_over(sensor::RecordedFrame frame);
    uint64_t lost() const;

    static constexpr uint64_t kNotAsked = UINT64_MAX;

    sensor::kinect2::Device device_;
    sensor::RecordedSequence sequence_;
    Kinect2Packer packer_;  ///< of the capturing thread alone
    Tap tap_;
    sensor::Newest<sensor::RecordedFrame> newest_;
    std::atomic<uint64_t> lost_before_ = kNotAsked;  ///< before the first next()
    std::mutex tap_mutex_;                           ///< held while the tap runs
    bool stopped_ = false;                           ///< of tap_mutex_
    mutable std::mutex clock_mutex_;
    std::optional<Clock::time_point> origin_;  ///< of clock_mutex_: when the device's clock was at 0, at the latest
    std::jthread thread_;                      // last: joins before what it uses is destroyed
};

}  // namespace patina::cameras
