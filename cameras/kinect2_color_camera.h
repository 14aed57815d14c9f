#pragma once

#include "passes/kinect2/tables.h"
#include "patina/camera.h"

namespace patina::cameras {

/// A Kinect v2's colour camera as Patina's passes take it, for pictures that are mirrored back.
struct FittedColorCamera {
    Intrinsics color;                      ///< 1920 x 1080, with lens distortion
    RigidTransform color_from_depth{1.0};  ///< from the pinhole camera of undistorted depth
    double rms_px = 0;                     ///< how far it is from the device's own polynomials, colour pixels
    double max_px = 0;
};

/// The device describes its colour camera by polynomials of depth pixels alone. This fits a lens and a pose to them, on
/// a grid of depth pixels at distances from 0.5 to 4.5 m that the colour picture shows. Throws Error when the colour
/// picture shows too few of them, or nothing fits.
FittedColorCamera fit_color_camera(const kinect2::HostTables& tables);

}  // namespace patina::cameras
