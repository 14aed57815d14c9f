#include "engine/core/shader_camera.h"

namespace patina {

gpu::Camera make_camera(const Intrinsics& intrinsics, const RigidTransform& world_from_camera) {
    gpu::Camera camera{};
    camera.camera_from_world = glm::mat4(rigid_inverse(world_from_camera));
    camera.focal_center_px = glm::vec4(intrinsics.fx, intrinsics.fy, intrinsics.cx, intrinsics.cy);
    camera.extent = glm::uvec2(intrinsics.extent.width, intrinsics.extent.height);
    return camera;
}

}  // namespace patina
