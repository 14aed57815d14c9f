#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "reconstruction/session/tracked_frame.h"

namespace patina {

/// How many frames were in each state, and of each frame its state and what that depends on.
nlohmann::ordered_json tracking_json(const std::vector<TrackedFrame>& frames);

/// Frames beside each other that were in one state for one kind of reason.
struct TrackingStretch {
    uint32_t first = 0, last = 0;  ///< indices
    TrackingState state = TrackingState::kTracking;
    std::string reason;  ///< of the first
};

/// The stretches that a sequence falls into.
std::vector<TrackingStretch> stretches_of(const std::vector<TrackedFrame>& frames);

/// The same as rows of a table in HTML; empty without frames.
std::string tracking_table(const std::vector<TrackedFrame>& frames);

}  // namespace patina
