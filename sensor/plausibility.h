#pragma once

#include <string>
#include <vector>

#include "sensor/inspect.h"

namespace patina::sensor {

/// What about a report's numbers is implausible for a recorded room or object: scale, intrinsics, poses, timestamps,
/// repetitions. One sentence each; `report.warnings` is not used.
std::vector<std::string> implausibilities(const SequenceReport& report);

}  // namespace patina::sensor
