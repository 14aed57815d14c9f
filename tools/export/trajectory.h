#pragma once

#include <span>
#include <string>

#include "engine/core/camera.h"

namespace patina {

/// A camera's pose at a time.
struct TimedPose {
    double timestamp_s = 0;
    RigidTransform world_from_camera{1.0};
};

/// The poses in TUM's format, a line 'timestamp tx ty tz qx qy qz qw' each: seconds and metres with six decimals, the
/// unit quaternion with nine and its sign chosen so that qw >= 0. Throws Error for a pose that is not rigid or not
/// finite.
std::string trajectory_text(std::span<const TimedPose> poses);

}  // namespace patina
