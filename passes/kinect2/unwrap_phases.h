#pragma once

#include "passes/kinect2/decode_settings.h"
#include "passes/kinect2/measure_phases.h"

namespace patina::kinect2 {

/// Unwraps the phases of the three frequencies against each other and turns them into depth (libfreenect2, stages 1 and
/// 2). Depth is unambiguous up to 18.75 m. With `smooth_phases`, the phasors of each frequency go through a joint
/// bilateral filter over 3 x 3 pixels before: neighbours weigh by a Gaussian and by how well their phase agrees. Border
/// pixels stay as they are. Returns 512 x 424 rgba32f, as the sensor's pixels are: x is depth in mm along the optical
/// axis, 0 where it is dark or the phases disagree; y the amplitudes' sum, negated where the phases around a pixel
/// disagree at any frequency; z the infrared light of PhasorIds::c.
graph::ImageId add_unwrap_phases(graph::FrameGraph& frame, const TableIds& tables, const PhasorIds& phasors,
                                 const DecodeSettings& settings);

}  // namespace patina::kinect2
