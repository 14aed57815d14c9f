#pragma once

#include <chrono>
#include <thread>

#include "sensor/live/live_source.h"
#include "tools/program/interrupt.h"

namespace patina::tools {

/// Stops a camera when the user asks or its time is over, even one that has fallen silent: a thread of its own looks.
class CameraWatch {
  public:
    /// `seconds` from now on; 0: no limit. Both references outlive it.
    CameraWatch(sensor::LiveCapture& capture, const InterruptGuard& interrupt, double seconds = 0)
        : thread_([&capture, &interrupt, seconds](std::stop_token stop) {
              const auto start = std::chrono::steady_clock::now();
              const auto is_over = [&] {
                  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
                  return interrupt.requested() || (seconds > 0 && passed.count() >= seconds);
              };
              while (!stop.stop_requested() && !is_over()) std::this_thread::sleep_for(kInterval);
              if (!stop.stop_requested()) capture.stop();
          }) {}

  private:
    static constexpr std::chrono::milliseconds kInterval{50};
    std::jthread thread_;
};

}  // namespace patina::tools
