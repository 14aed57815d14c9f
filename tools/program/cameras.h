#pragma once

#include <memory>
#include <string>

#include "cameras/kinect2_capture.h"

namespace patina::tools {

/// The name of a camera on the command line: the first Kinect v2 that is connected.
inline constexpr const char* kKinect2 = "kinect2";

bool is_camera(const std::string& source);

/// Opens and starts the first Kinect v2; prints what works less well than it should. Throws Error as
/// sensor::kinect2::open_usb() and Kinect2Capture.
std::shared_ptr<cameras::Kinect2Capture> open_kinect2();

}  // namespace patina::tools
