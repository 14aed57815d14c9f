#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "sensor/kinect2/calibration.h"
#include "sensor/kinect2/settings.h"
#include "sensor/kinect2/startup.h"
#include "sensor/kinect2/stream.h"

namespace patina::sensor::kinect2 {

struct DeviceOptions {
    size_t queued_frames = 3;  ///< pairs that wait for next(); the oldest gives way
    /// Of each stream, that wait for the assembling thread while it is late: 64 ms of infrared, 17 MB.
    size_t waiting_transfers = 64;
    std::chrono::milliseconds silence{2000};  ///< without a pair, after which next() throws
    Readiness readiness;
};

/// A Kinect v2, from being opened to raw frames. One thread owns it; interrupt(), statistics() and the settings may be
/// called from any.
class Device {
  public:
    /// Takes an opened device and prepares it. Throws as prepare().
    explicit Device(std::unique_ptr<Transport> transport, DeviceOptions options = {});
    /// Stops it. What the device answers to that does not matter.
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    /// Starts both streams, anew where they run. A start that fails is tried once more after a reset. The settings hold
    /// from one run to the next. Throws Unplugged, or Error when the device does not start or its calibration is
    /// damaged.
    void start();

    /// Exchanges the next frame with `frame`, whose buffers are reused; waits for it. False after interrupt(). Throws
    /// Unplugged, Error when no frame comes for a while, with what was lost on the way, or Error when the streams end.
    bool next(RawFrame& frame);

    /// Throws away the frames that wait for next(), so that it yields what comes from now on. Does nothing when no
    /// streams run.
    void forget_waiting();

    /// Stops the streams. Does nothing when none run. Throws Error when the device refuses; not when it is gone.
    void stop();

    /// Makes next() return at once, until start() is called again.
    void interrupt();

    /// Of the present or last run: the phase offsets hold for it alone.
    const Calibration& calibration() const { return calibration_; }
    const CalibrationPages& pages() const { return pages_; }
    /// "Kinect v2 at 2-1".
    const std::string& name() const { return transport_->name(); }
    /// What works less well than it should; empty: nothing.
    std::string warning() const;
    /// Of the present or last run.
    StreamStatistics statistics() const;

    /// Holds at once while the streams run, and after each start. Waits while another thread starts or stops the
    /// device. Throws as in settings.h.
    void set_exposure(const ExposureControl& exposure);
    void set_white_balance(const std::optional<WhiteBalanceGains>& gains);
    /// The gains in force. Throws as Commands::execute().
    WhiteBalanceGains white_balance();

  private:
    void start_once();
    void stop_run();
    void apply_settings();
    void halt() noexcept;
    std::shared_ptr<Stream> stream() const;
    [[noreturn]] void fail_silent(const StreamStatistics& statistics) const;

    std::unique_ptr<Transport> transport_;
    DeviceOptions options_;
    Commands commands_;
    CalibrationPages pages_;
    Calibration calibration_;

    std::mutex sending_;  ///< held while the device is started, stopped or set: a reset loses what others have sent
    mutable std::mutex mutex_;        ///< of what follows
    std::shared_ptr<Stream> stream_;  ///< of the present run
    StreamStatistics last_run_;
    bool running_ = false;  ///< the sensors were started and not stopped
    bool interrupted_ = false;
    std::optional<ExposureControl> exposure_;
    std::optional<std::optional<WhiteBalanceGains>> white_balance_;
};

}  // namespace patina::sensor::kinect2
