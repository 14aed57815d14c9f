#pragma once

#include <cstdint>

namespace patina::sensor::kinect2 {

/// How far `later` is after `earlier` on a 32-bit counter that wraps; negative where it is before.
constexpr int32_t distance(uint32_t earlier, uint32_t later) { return static_cast<int32_t>(later - earlier); }

/// How many sequence numbers lie between two that came one after the other: frames lost. A counter that went back was
/// started anew, and nothing is known to be lost.
constexpr uint32_t numbers_between(uint32_t earlier, uint32_t later) {
    return distance(earlier, later) > 0 ? later - earlier - 1 : 0;
}

}  // namespace patina::sensor::kinect2
