#pragma once

#include <memory>
#include <string>

#include "cameras/kinect2_capture.h"
#include "sensor/live/camera_source.h"

namespace patina::tools {

/// Names of cameras on the command line: the first Kinect v2, the first Kinect v1, the first camera of OpenNI2; of the
/// last also "openni2:URI".
inline constexpr const char* kKinect2 = "kinect2";
inline constexpr const char* kKinect1 = "kinect1";
inline constexpr const char* kOpenNi2 = "openni2";
/// All of them, for sentences.
inline constexpr const char* kCameraNames = "kinect2, kinect1, openni2 or openni2:URI";

bool is_camera(const std::string& source);

/// Opens and starts the first Kinect v2; prints what works less well than it should. Throws Error as
/// sensor::kinect2::open_usb() and Kinect2Capture.
std::shared_ptr<cameras::Kinect2Capture> open_kinect2();

/// Opens another camera than a Kinect v2, which starts when it is asked for a frame. Throws Error as
/// sensor::open_kinect1() and sensor::open_openni2().
std::shared_ptr<sensor::CameraSource> open_other_camera(const std::string& name);

/// Opens a recording of a Kinect v2's raw frames that is to play as the camera sent them (cameras::PlayedCapture); null
/// where it holds something else, which sensor::PlayedSource plays. Throws Error as sensor::RecordingFile, and where it
/// holds no frame.
std::shared_ptr<cameras::RawCapture> open_raw_to_play(const std::string& recording);

}  // namespace patina::tools
