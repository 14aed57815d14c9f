#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "patina/camera.h"

namespace patina::tools {

/// Camera poses (world_from_camera) on a level circle around a centre, from above the first recorded camera's side on:
/// as far from the centre along the level, and as high above it, as the median of the recorded cameras, at least
/// kLeastOrbit_m away; all look at the centre. They go once around, evenly spaced. Where no camera that looked at the
/// centre, to 45 degrees, stood within a quarter of the circle or more, nothing was seen from there: then they swing
/// over the rest, 10 degrees beyond its ends, and back. Up is the mean of the recorded cameras' up directions, levelled
/// by their x axes. `recorded` is not empty. Throws Error when the cameras' up directions cancel out.
std::vector<RigidTransform> orbit_poses(std::span<const RigidTransform> recorded, glm::dvec3 center_m, uint32_t count);

inline constexpr double kLeastOrbit_m = 0.3;

/// The median of the points by coordinate, which a few outliers do not move. `points` is not empty.
glm::dvec3 median_point(std::span<const glm::vec3> points);

}  // namespace patina::tools
