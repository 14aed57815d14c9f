#include "tests/reference/scenes/analytic_scene.h"

#include <algorithm>
#include <cmath>

namespace patina::reference {

DistanceField sphere(glm::dvec3 center_m, double radius_m) {
    return [=](glm::dvec3 p) { return glm::length(p - center_m) - radius_m; };
}

DistanceField box(glm::dvec3 center_m, glm::dvec3 half_extent_m) {
    return [=](glm::dvec3 p) {
        const glm::dvec3 q = glm::abs(p - center_m) - half_extent_m;
        return glm::length(glm::max(q, glm::dvec3(0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
    };
}

DistanceField half_space(glm::dvec3 normal, double offset_m) {
    return [=](glm::dvec3 p) { return glm::dot(normal, p) - offset_m; };
}

glm::dvec3 normal_at(const DistanceField& field, glm::dvec3 point_m) {
    constexpr double kStep = 1e-5;
    glm::dvec3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 offset(0);
        offset[axis] = kStep;
        gradient[axis] = field(point_m + offset) - field(point_m - offset);
    }
    return glm::normalize(gradient);
}

Image<float> render_depth(const DistanceField& field, const Intrinsics& camera, const RigidTransform& world_from_camera,
                          double far_m) {
    Image<float> depth(camera.extent);
    const glm::dvec3 eye(world_from_camera[3]);
    for (uint32_t y = 0; y < camera.extent.height; ++y) {
        for (uint32_t x = 0; x < camera.extent.width; ++x) {
            const glm::dvec3 ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1);
            const glm::dvec3 direction = glm::dmat3(world_from_camera) * glm::normalize(ray);
            double along = 0;
            double distance = field(eye);
            for (int step = 0; step < 512 && distance > 1e-7 && along < 2 * far_m; ++step) {
                along += distance;
                distance = field(eye + along * direction);
            }
            const double z = along / glm::length(ray);
            if (distance < 1e-5 && z <= far_m) depth.at(x, y) = static_cast<float>(z);
        }
    }
    return depth;
}

RigidTransform look_at(glm::dvec3 eye_m, glm::dvec3 target_m) {
    const glm::dvec3 forward = glm::normalize(target_m - eye_m);
    const glm::dvec3 world_down(0, 1, 0);
    const glm::dvec3 right = glm::normalize(glm::cross(world_down, forward));
    const glm::dvec3 down = glm::cross(forward, right);
    RigidTransform pose(1.0);
    pose[0] = glm::dvec4(right, 0);
    pose[1] = glm::dvec4(down, 0);
    pose[2] = glm::dvec4(forward, 0);
    pose[3] = glm::dvec4(eye_m, 1);
    return pose;
}

std::vector<RigidTransform> orbit(glm::dvec3 target_m, double distance_m, int views) {
    std::vector<RigidTransform> poses;
    for (int i = 0; i < views; ++i) {
        const double height = 0.9 * (2.0 * (i + 0.5) / views - 1.0);
        const double radius = std::sqrt(1 - height * height), angle = 2.399963 * i;
        const glm::dvec3 direction(radius * std::cos(angle), height, radius * std::sin(angle));
        poses.push_back(look_at(target_m + distance_m * direction, target_m));
    }
    return poses;
}

}  // namespace patina::reference
