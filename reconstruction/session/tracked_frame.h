#pragma once

#include <cstdint>

#include "passes/tracking/judge_motion.h"

namespace patina {

/// How one frame was tracked.
struct TrackedFrame {
    uint32_t index = 0;
    TrackingReport report;
};

}  // namespace patina
