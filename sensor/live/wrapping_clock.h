#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace patina::sensor {

/// Seconds of a counter of 32 bits that wraps, and that two streams are stamped by. Each stream's own time never runs
/// backwards; the streams may be apart by less than half a turn when the second one begins.
class WrappingClock {
  public:
    explicit WrappingClock(double ticks_per_s) : ticks_per_s_(ticks_per_s) {}

    /// Of the next picture of a stream, 0 or 1.
    double seconds(size_t stream, uint32_t ticks) {
        std::optional<uint64_t>& mine = last_[stream];
        const std::optional<uint64_t>& other = last_[1 - stream];
        if (mine) {
            *mine += ticks - static_cast<uint32_t>(*mine);
        } else if (other) {
            mine = *other + static_cast<uint64_t>(int64_t{static_cast<int32_t>(ticks - static_cast<uint32_t>(*other))});
        } else {
            mine = (uint64_t{1} << 32) + ticks;
        }
        return static_cast<double>(*mine) / ticks_per_s_;
    }

  private:
    double ticks_per_s_;
    std::array<std::optional<uint64_t>, 2> last_;
};

}  // namespace patina::sensor
