#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>

#include "sensor/live/live_source.h"

namespace patina::sensor {

/// Where a camera's thread leaves readings for the consumer: the newest frame, and before it, one after the other, what
/// was dropped or damaged. Both sides may be on any thread.
class NewestFrame {
  public:
    /// Takes the next reading; a frame that still waits becomes Skipped.
    void put(Reading reading);

    /// No more readings come; take() ends after those that wait. With a failure, it throws that then.
    void end(std::exception_ptr failure = nullptr);

    /// Waits for a reading; empty at the end.
    std::optional<Reading> take();

    LiveCounts counts() const;

  private:
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Skipped> before_;  ///< dropped and damaged, older than frame_
    std::optional<Frame> frame_;
    bool ended_ = false;
    std::exception_ptr failure_;
    LiveCounts counts_;
};

}  // namespace patina::sensor
