#pragma once

#include <optional>

#include <glm/glm.hpp>

#include "patina/camera.h"

namespace patina::sensor {

/// The pinhole camera of a horizontal and vertical field of view, radians, whose axis goes through the picture's
/// middle. Without a view, or with one that no camera has, it is OpenNI's default: a focal length of 525 px at a width
/// of 640.
Intrinsics intrinsics_of(Extent2D extent, const std::optional<glm::dvec2>& view_rad);

}  // namespace patina::sensor
