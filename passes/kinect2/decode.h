#pragma once

#include <span>

#include "passes/kinect2/decode_settings.h"
#include "passes/kinect2/undistort_depth.h"

namespace patina::kinect2 {

/// Decodes an infrared frame as the sensor sends it (add_measure_phases) to depth and infrared images of a pinhole
/// camera. Throws Error as the passes it consists of.
UndistortedImages add_decode(graph::FrameGraph& frame, const TableIds& tables, std::span<const uint8_t> infrared,
                             const DecodeSettings& settings = {});

}  // namespace patina::kinect2
