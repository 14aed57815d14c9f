#include "scenes/description/pose_noise.h"

#include <random>

#include <glm/gtc/matrix_transform.hpp>

namespace patina::scenes {

RigidTransform with_pose_noise(const RigidTransform& world_from_camera, const SensorNoise& noise, const NoiseKey& key) {
    if (noise.pose_translation_m == 0 && noise.pose_rotation_rad == 0) return world_from_camera;
    std::seed_seq seeds{static_cast<uint32_t>(key.seed), static_cast<uint32_t>(key.seed >> 32), key.frame};
    std::mt19937_64 random(seeds);
    std::normal_distribution<double> gaussian;
    const auto next = [&](double sigma) {
        const double x = gaussian(random), y = gaussian(random), z = gaussian(random);
        return sigma * glm::dvec3(x, y, z);
    };
    const glm::dvec3 translation_m = next(noise.pose_translation_m), rotation = next(noise.pose_rotation_rad);
    const double angle_rad = glm::length(rotation);
    const RigidTransform moved = glm::translate(world_from_camera, translation_m);
    return angle_rad == 0 ? moved : glm::rotate(moved, angle_rad, rotation / angle_rad);
}

}  // namespace patina::scenes
