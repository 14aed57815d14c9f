#pragma once

#include <cstdint>
#include <optional>

#include "sensor/kinect2/raw_frame.h"
#include "sensor/kinect2/sequence.h"

namespace patina::sensor::kinect2 {

/// Turns the device's 32-bit ticks, which wrap after 149 hours, into seconds since the first frame that never run
/// backwards.
class TickClock {
  public:
    /// Seconds of the next frame's time stamp. One that lies before the last, as after a restart, counts as the last.
    double seconds(uint32_t ticks) {
        if (last_ && distance(*last_, ticks) > 0) elapsed_ += ticks - *last_;
        last_ = ticks;
        return static_cast<double>(elapsed_) * kSecondsPerTick;
    }

  private:
    std::optional<uint32_t> last_;
    uint64_t elapsed_ = 0;  ///< ticks since the first
};

}  // namespace patina::sensor::kinect2
