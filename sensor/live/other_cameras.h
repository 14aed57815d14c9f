#pragma once

#include <memory>
#include <string>

#include "sensor/live/picture_camera.h"

namespace patina::sensor {

/// Cameras through libraries of others, where these were installed when Patina was built.

/// The first Kinect v1 (Kinect for Xbox 360, or for Windows), by libfreenect. Its depth is registered to colour by the
/// device's own calibration: both pictures have 640 x 480 pixels and one pinhole camera, the colour camera's nominal
/// one (kKinect1Focal_px). Depth is in millimetres. A library that only has the 11 bits of disparity, such as Debian's
/// fakenect, gives depth of a nominal device: by a formula, in a depth camera of its own beside the colour camera.
/// Times are those of the device's clock of 60 MHz, the same for both pictures. Exposure and white balance are
/// automatic. Throws Error where there is none, it cannot be opened, or Patina was built without libfreenect.
std::unique_ptr<PictureCamera> open_kinect1();
inline constexpr double kKinect1Focal_px = 525, kKinect1DepthFocal_px = 580;
inline constexpr double kKinect1Baseline_m = 0.025;  ///< from the depth to the colour camera, to the right

/// A camera of OpenNI2, such as an Asus Xtion or a PrimeSense Carmine; `uri` is one of its list, empty: the first.
/// Depth is registered to colour where the device can do that; both have then the colour camera's field of view. Depth
/// is in the device's unit. Times are its microseconds. Exposure is as the driver has it. Throws Error as
/// open_kinect1().
std::unique_ptr<PictureCamera> open_openni2(const std::string& uri);

/// What `patina doctor` prints of both: indented lines.
std::string kinect1_report();
std::string openni2_report();

}  // namespace patina::sensor
