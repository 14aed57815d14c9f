#pragma once

#include <string>
#include <string_view>

#include "scenes/description/recording.h"

namespace patina::scenes {

/// The errors of a named sensor. Poses stay exact. Throws Error listing the names for another one.
///   none      a perfect sensor that only quantises
///   kinect1   structured light: depth sigma 0.0012 + 0.0019 (z - 0.4)^2 m
///   kinect2   time of flight: depth sigma 0.001 + 0.00025 z^2 m
/// Both Kinects also have flying pixels at depth edges, and shot and read noise in colour.
SensorNoise noise_preset(std::string_view name);

/// "kinect1, kinect2, none"
std::string noise_preset_names();

}  // namespace patina::scenes
