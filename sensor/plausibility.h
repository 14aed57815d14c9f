#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sensor/inspect.h"

namespace patina::sensor {

/// One sentence when the depth is too near or too far for a recorded room or object: by how much, and which unit would
/// fit. Empty without a valid reading.
std::optional<std::string> implausible_scale(const SequenceReport& report);

/// What about a report's numbers is implausible for a recorded room or object: scale, intrinsics, poses, timestamps,
/// repetitions. One sentence each; `report.warnings` is not used.
std::vector<std::string> implausibilities(const SequenceReport& report);

}  // namespace patina::sensor
