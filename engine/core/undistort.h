#pragma once

#include <optional>

#include "patina/camera.h"

namespace patina {

/// The normalised image point that distort() moves to `distorted`, by Newton's method from there. Empty where that does
/// not converge, as beyond the radius where the distortion folds back.
std::optional<glm::dvec2> undistort(const Intrinsics& camera, glm::dvec2 distorted);

}  // namespace patina
