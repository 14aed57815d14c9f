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

/// Opens a recording that is to play as a camera would (sensor::PlayedSource). Throws Error as sensor::open_sequence,
/// and where it holds a camera's raw frames: these are decoded on a device, which is not the player's.
std::unique_ptr<Source> open_to_play(const std::string& recording, const std::string& format);

}  // namespace patina::tools
