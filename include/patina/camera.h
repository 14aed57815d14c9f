#pragma once

#include <array>

#include <glm/glm.hpp>

#include "patina/image.h"

namespace patina {

/// A camera's image size, pinhole parameters in pixels, and lens distortion. Pixel (0, 0) is the centre of the top left
/// pixel; axes are OpenCV's: x right, y down, z forward.
struct Intrinsics {
    Extent2D extent;
    double fx = 0, fy = 0, cx = 0, cy = 0;
    std::array<double, 5> distortion{};  ///< OpenCV's k1 k2 p1 p2 k3

    bool operator==(const Intrinsics&) const = default;
    bool distorted() const { return distortion != std::array<double, 5>{}; }
};

/// Where OpenCV's distortion moves the normalised image point (x, y); the inverse of undistortion.
glm::dvec2 distort(const Intrinsics& camera, glm::dvec2 point);

/// Returns the pixel at which a point in camera coordinates (metres) appears, lens distortion included.
glm::dvec2 project(const Intrinsics& camera, glm::dvec3 point_m);

/// The same camera for an image resampled to `extent` (pixel centres stay pixel centres of the scaled grid).
Intrinsics scaled_to(const Intrinsics& camera, Extent2D extent);

/// A rigid transform as a column-major matrix, in metres. Names say both frames: world_from_camera.
using RigidTransform = glm::dmat4;

/// The inverse of a rigid transform; the rotation must be orthonormal.
RigidTransform rigid_inverse(const RigidTransform& transform);

/// The rigid transform nearest to `transform`: its rotation re-orthonormalised, its last row reset.
RigidTransform orthonormalised(const RigidTransform& transform);

/// How far the upper left 3 x 3 matrix is from a rotation: the largest absolute entry of R^T R - I; at least 2 for a
/// reflection, infinite when an entry of the transform is not finite.
double rotation_defect(const RigidTransform& transform);

}  // namespace patina
