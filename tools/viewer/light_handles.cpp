#include "tools/viewer/light_handles.h"

#include <cmath>

namespace patina::tools {

namespace {

constexpr double kLeastDepth_m = 0.01;  // nearer points are at no pixel
constexpr double kPush = 1.0 / 12;

}  // namespace

std::optional<glm::dvec2> appears_at(const Intrinsics& camera, const RigidTransform& world_from_camera,
                                     glm::dvec3 point_m) {
    const glm::dvec3 in_camera(rigid_inverse(world_from_camera) * glm::dvec4(point_m, 1));
    if (in_camera.z < kLeastDepth_m) return std::nullopt;
    return project(camera, in_camera);
}

std::optional<size_t> light_at(std::span<const Light> lights, const Intrinsics& camera,
                               const RigidTransform& world_from_camera, glm::dvec2 pixel, double reach_px) {
    std::optional<size_t> nearest;
    for (size_t i = 0; i < lights.size(); ++i) {
        const auto at = appears_at(camera, world_from_camera, lights[i].position_m);
        if (!at || glm::distance(*at, pixel) > reach_px) continue;
        nearest = i;
        reach_px = glm::distance(*at, pixel);
    }
    return nearest;
}

glm::dvec3 dragged(glm::dvec3 point_m, const Intrinsics& camera, const RigidTransform& world_from_camera,
                   glm::dvec2 moved_px) {
    const double depth_m = (rigid_inverse(world_from_camera) * glm::dvec4(point_m, 1)).z;
    const glm::dvec2 moved_m = moved_px * depth_m / glm::dvec2(camera.fx, camera.fy);
    return point_m + moved_m.x * glm::dvec3(world_from_camera[0]) + moved_m.y * glm::dvec3(world_from_camera[1]);
}

glm::dvec3 pushed(glm::dvec3 point_m, const RigidTransform& world_from_camera, double steps) {
    const glm::dvec3 center_m(world_from_camera[3]);
    return center_m + (point_m - center_m) * std::pow(1 - kPush, steps);
}

}  // namespace patina::tools
