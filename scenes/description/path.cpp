#include "scenes/description/path.h"

#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/error.h"

namespace patina::scenes {
namespace {

constexpr glm::dvec3 kDown(0, 1, 0);

double oscillation(double amplitude, double period_s, double phase_rad, double time_s) {
    return amplitude * std::sin(2 * std::numbers::pi * time_s / period_s + phase_rad);
}

RigidTransform looking(glm::dvec3 center_m, glm::dvec3 forward) {
    const glm::dvec3 sideways = glm::cross(kDown, forward);
    PATINA_ASSERT(glm::length(sideways) > 1e-6, "optical axis ", forward.x, ' ', forward.y, ' ', forward.z);
    const glm::dvec3 right = glm::normalize(sideways);
    const glm::dvec3 down = glm::cross(forward, right);
    return {glm::dvec4(right, 0), glm::dvec4(down, 0), glm::dvec4(forward, 0), glm::dvec4(center_m, 1)};
}

RigidTransform pose(const OrbitPath& path, double time_s) {
    const double azimuth = path.azimuth_rad + oscillation(path.azimuth_amplitude_rad, path.azimuth_period_s,
                                                          path.azimuth_phase_rad, time_s);
    const double elevation = path.elevation_rad + oscillation(path.elevation_amplitude_rad, path.elevation_period_s,
                                                              path.elevation_phase_rad, time_s);
    const glm::dvec3 forward(-std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                             std::cos(elevation) * std::cos(azimuth));
    return looking(path.target_m - path.distance_m * forward, forward);
}

/// Uniform Catmull-Rom between b and c.
glm::dvec3 spline(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 d, double t) {
    return 0.5 * (2.0 * b + t * ((c - a) + t * ((2.0 * a - 5.0 * b + 4.0 * c - d) + t * (3.0 * (b - c) + d - a))));
}

Waypoint waypoint_at(const WaypointPath& path, double time_s) {
    const auto count = static_cast<int64_t>(path.waypoints.size());
    PATINA_ASSERT(count >= 2, "waypoints ", count);
    const double phase = time_s / path.period_s * static_cast<double>(count);
    const auto segment = static_cast<int64_t>(std::floor(phase));
    const auto at = [&](int64_t offset) {
        return path.waypoints[static_cast<size_t>(((segment + offset) % count + count) % count)];
    };
    const Waypoint a = at(-1), b = at(0), c = at(1), d = at(2);
    const double t = phase - std::floor(phase);
    return {spline(a.position_m, b.position_m, c.position_m, d.position_m, t),
            spline(a.target_m, b.target_m, c.target_m, d.target_m, t)};
}

RigidTransform pose(const WaypointPath& path, double time_s) {
    const Waypoint now = waypoint_at(path, time_s);
    return looking(now.position_m, glm::normalize(now.target_m - now.position_m));
}

SteepestView steepest(const OrbitPath& path) {
    const bool same_sign = path.elevation_rad * path.elevation_amplitude_rad >= 0;
    const double turns = (same_sign ? 0.25 : 0.75) - path.elevation_phase_rad / (2 * std::numbers::pi);
    return {std::abs(path.elevation_rad) + std::abs(path.elevation_amplitude_rad),
            path.elevation_period_s * (turns - std::floor(turns))};
}

SteepestView steepest(const WaypointPath& path) {
    const size_t samples = 256 * path.waypoints.size();
    SteepestView steepest;
    for (size_t i = 0; i < samples; ++i) {
        const double time_s = path.period_s * static_cast<double>(i) / static_cast<double>(samples);
        const Waypoint now = waypoint_at(path, time_s);
        const glm::dvec3 axis = now.target_m - now.position_m;
        const double angle_rad = axis == glm::dvec3(0)
                                     ? std::numbers::pi / 2
                                     : std::atan2(std::abs(axis.y), glm::length(glm::dvec2(axis.x, axis.z)));
        if (angle_rad > steepest.angle_rad) steepest = {angle_rad, time_s};
    }
    return steepest;
}

}  // namespace

RigidTransform world_from_camera(const CameraPath& path, double time_s) {
    return std::visit([&](const auto& kind) { return pose(kind, time_s); }, path);
}

SteepestView steepest_view(const CameraPath& path) {
    return std::visit([](const auto& kind) { return steepest(kind); }, path);
}

RigidTransform placed(glm::dvec3 position_m, glm::dvec3 axis, double angle_rad) {
    return glm::rotate(glm::translate(RigidTransform(1.0), position_m), angle_rad, glm::normalize(axis));
}

}  // namespace patina::scenes
