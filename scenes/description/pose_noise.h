#pragma once

#include "scenes/description/recording.h"

namespace patina::scenes {

/// A pose as a tracker reports it: moved, in the camera's own axes, by a translation and by a rotation vector whose
/// components are Gaussians of pose_translation_m and pose_rotation_rad. The same key gives the same errors. Without
/// noise it is the true pose.
RigidTransform with_pose_noise(const RigidTransform& world_from_camera, const SensorNoise& noise, const NoiseKey& key);

}  // namespace patina::scenes
