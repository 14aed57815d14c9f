#pragma once

#include <optional>
#include <span>

#include <glm/glm.hpp>

#include "patina/camera.h"
#include "patina/lighting.h"

namespace patina::tools {

/// Where a point appears in a pinhole camera's picture, pixels; empty where it is behind the camera.
std::optional<glm::dvec2> appears_at(const Intrinsics& camera, const RigidTransform& world_from_camera,
                                     glm::dvec3 point_m);

/// The light whose handle is nearest to a pixel, at most `reach_px` away.
std::optional<size_t> light_at(std::span<const Light> lights, const Intrinsics& camera,
                               const RigidTransform& world_from_camera, glm::dvec2 pixel, double reach_px);

/// The point moved by so many pixels along the picture, at its depth.
glm::dvec3 dragged(glm::dvec3 point_m, const Intrinsics& camera, const RigidTransform& world_from_camera,
                   glm::dvec2 moved_px);

/// The point moved along the line of sight: nearer (above 0) by a twelfth of its distance a step.
glm::dvec3 pushed(glm::dvec3 point_m, const RigidTransform& world_from_camera, double steps);

}  // namespace patina::tools
