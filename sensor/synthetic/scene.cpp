#include "sensor/synthetic/scene.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/error.h"
#include "sensor/synthetic/cubes.h"

namespace patina::sensor {
namespace {

constexpr glm::dvec3 kDown(0, 1, 0);

double oscillation(double amplitude, double period_s, double time_s) {
    return amplitude * std::sin(2 * std::numbers::pi * time_s / period_s);
}

}  // namespace

RigidTransform world_from_camera(const OrbitPath& path, double time_s) {
    const double azimuth = oscillation(path.azimuth_amplitude_rad, path.azimuth_period_s, time_s);
    const double elevation =
        path.elevation_rad + oscillation(path.elevation_amplitude_rad, path.elevation_period_s, time_s);
    PATINA_ASSERT(std::abs(elevation) < std::numbers::pi / 2, "elevation ", elevation, " rad");
    const glm::dvec3 forward(-std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                             std::cos(elevation) * std::cos(azimuth));
    const glm::dvec3 right = glm::normalize(glm::cross(kDown, forward));
    const glm::dvec3 down = glm::cross(forward, right);
    const glm::dvec3 center_m = path.target_m - path.distance_m * forward;
    return {glm::dvec4(right, 0), glm::dvec4(down, 0), glm::dvec4(forward, 0), glm::dvec4(center_m, 1)};
}

RigidTransform placed(glm::dvec3 position_m, glm::dvec3 axis, double angle_rad) {
    return glm::rotate(glm::translate(RigidTransform(1.0), position_m), angle_rad, glm::normalize(axis));
}

std::vector<Material> materials_of(const Scene& scene) {
    std::vector<Material> materials;
    std::transform(scene.objects.begin(), scene.objects.end(), std::back_inserter(materials),
                   [](const SceneObject& object) { return object.material; });
    return materials;
}

Scene make_scene(const std::string& name) {
    if (name == "cubes") return make_cubes();
    throw Error("there is no built-in scene '", name, "'; there is: cubes");
}

}  // namespace patina::sensor
