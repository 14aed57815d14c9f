#pragma once

#include <span>
#include <string>

#include "patina/scene.h"

namespace patina {

/// The poses in TUM's format, a line 'timestamp tx ty tz qx qy qz qw' each: seconds and metres with six decimals, the
/// unit quaternion with nine and its sign chosen so that qw >= 0. Throws Error for a pose that is not rigid or not
/// finite.
std::string trajectory_text(std::span<const TimedPose> poses);

}  // namespace patina
