#pragma once

#include <numbers>
#include <variant>
#include <vector>

#include <glm/glm.hpp>

#include "patina/camera.h"

namespace patina::scenes {

/// A camera that looks at a target from a fixed distance while azimuth and elevation oscillate:
/// azimuth(t) = mean + amplitude sin(2 pi t / period + phase), and elevation likewise.
struct OrbitPath {
    glm::dvec3 target_m{0};
    double distance_m = 4;
    double azimuth_rad = 0;  ///< mean; 0 looks along +z
    double azimuth_amplitude_rad = 0;
    double azimuth_period_s = 1;
    double azimuth_phase_rad = 0;
    double elevation_rad = 0;  ///< mean, above the horizon
    double elevation_amplitude_rad = 0;
    double elevation_period_s = 1;
    double elevation_phase_rad = 0;
};

/// Where the camera is, and what its optical axis passes through.
struct Waypoint {
    glm::dvec3 position_m{0};
    glm::dvec3 target_m{0, 0, 1};
};

/// A closed tour through waypoints, at equal times: a Catmull-Rom spline of positions and one of targets. At least two.
struct WaypointPath {
    std::vector<Waypoint> waypoints;
    double period_s = 10;  ///< of the whole tour
};

using CameraPath = std::variant<OrbitPath, WaypointPath>;

/// The camera's pose after `time_s`, the image upright. The optical axis must stay off the vertical: see steepest_view.
RigidTransform world_from_camera(const CameraPath& path, double time_s);

/// Beyond this, images turn fast about their centre.
inline constexpr double kSteepestView_rad = 89 * std::numbers::pi / 180;

/// How steeply a camera looks up or down.
struct SteepestView {
    double angle_rad = 0;  ///< between the optical axis and the horizontal; pi/2 also where the target is the camera
    double time_s = 0;     ///< when
};

/// The steepest view of a path's whole period: exact for an orbit, of 256 samples between two waypoints for a tour.
SteepestView steepest_view(const CameraPath& path);

/// The pose of an object turned by `angle_rad` about `axis` (of any length), then moved to `position_m`.
RigidTransform placed(glm::dvec3 position_m, glm::dvec3 axis, double angle_rad);

}  // namespace patina::scenes
