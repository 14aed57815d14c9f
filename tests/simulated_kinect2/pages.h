#pragma once

#include "sensor/kinect2/calibration.h"

namespace patina::sensor::kinect2::testing {

/// A made-up device: the cameras of a unit that was reported, phase offsets that vary smoothly, with the constants that
/// every unit has in columns 0 and 511.
Calibration simulated_calibration();

/// A calibration as the device's pages hold it, at full length.
CalibrationPages pages_of(const Calibration& calibration);

}  // namespace patina::sensor::kinect2::testing
