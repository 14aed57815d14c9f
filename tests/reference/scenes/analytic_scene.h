#pragma once

#include <functional>
#include <vector>

#include <glm/glm.hpp>

#include "patina/camera.h"
#include "patina/image.h"

namespace patina::reference {

/// The signed distance of a scene at a world point (metres), positive in free space.
using DistanceField = std::function<double(glm::dvec3)>;

DistanceField sphere(glm::dvec3 center_m, double radius_m);
/// A box with its axes along the world's.
DistanceField box(glm::dvec3 center_m, glm::dvec3 half_extent_m);
/// The half-space behind a plane: points with dot(normal, p) < offset_m are inside.
DistanceField half_space(glm::dvec3 normal, double offset_m);

/// A distance field's gradient by central differences, normalised.
glm::dvec3 normal_at(const DistanceField& field, glm::dvec3 point_m);

/// Depth along the optical axis (metres) of the field as a camera sees it, by sphere tracing in double precision; 0
/// where the ray meets nothing within `far_m`.
Image<float> render_depth(const DistanceField& field, const Intrinsics& camera, const RigidTransform& world_from_camera,
                          double far_m);

/// A camera at `eye` that looks at `target`, y down: world_from_camera.
RigidTransform look_at(glm::dvec3 eye_m, glm::dvec3 target_m);

/// Views from all around a point, a golden-angle spiral: world_from_camera of each.
std::vector<RigidTransform> orbit(glm::dvec3 target_m, double distance_m, int views);

}  // namespace patina::reference
