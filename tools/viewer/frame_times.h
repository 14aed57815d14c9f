#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "engine/graph/runner.h"

namespace patina::tools {

/// What a frame takes, as means over the last kMeanOf frames that were fused.
class FrameTimes {
  public:
    static constexpr size_t kMeanOf = 30;

    /// A frame was fused, at `now_s` on any clock. `passes`: Runner::pass_timings(), whose samples come a little late.
    void fused(double now_s, std::span<const graph::Timing> passes);

    /// The time until the next frame is none of a frame's: the run was paused.
    void paused() { last_s_.reset(); }

    /// From one frame to the next, milliseconds: work on the host and waiting for the camera included. 0: not known.
    double interval_ms() const { return mean(intervals_ms_); }
    /// All passes of a frame on the device together, pictures that are drawn included, milliseconds. 0: not known.
    double device_ms() const { return mean(device_ms_); }

  private:
    static double mean(const std::deque<double>& values);
    static void keep(std::deque<double>& values, double value);

    std::deque<double> intervals_ms_, device_ms_;
    std::map<std::string, size_t> counted_;  ///< samples of each pass
    std::optional<double> last_s_;
};

}  // namespace patina::tools
