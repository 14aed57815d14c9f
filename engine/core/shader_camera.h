#pragma once

#include "patina/camera.h"
#include "shared/input/camera.h"

namespace patina {

/// A camera at a pose, as shaders take it. Lens distortion must have been removed from its images before; it is not
/// carried over.
gpu::Camera make_camera(const Intrinsics& intrinsics, const RigidTransform& world_from_camera);

}  // namespace patina
