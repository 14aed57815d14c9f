#pragma once

#include "patina/camera.h"
#include "tests/reference/fusion/volume.h"

namespace patina::reference {

/// Depth along the optical axis (metres) at which each pixel's ray first crosses from the outside into the inside of a
/// volume's interpolated surface, in small steps through cells of which all corners have been seen; 0 where it does not
/// between the two depths.
Image<float> raycast(const Volume& volume, const Intrinsics& camera, const RigidTransform& world_from_camera,
                     double near_m, double far_m);

}  // namespace patina::reference
