#pragma once

#include "passes/input/unproject_depth.h"
#include "patina/camera.h"
#include "patina/image.h"

namespace patina::reference {

struct Surface {
    Image<glm::vec4> position_m;
    Image<glm::vec4> normal;
};

/// What add_unproject_depth computes.
Surface unproject_depth(const Image<float>& depth_m, const Intrinsics& camera, const RigidTransform& world_from_camera,
                        const DepthJump& jump);

}  // namespace patina::reference
