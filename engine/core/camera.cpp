#include "patina/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/gtc/quaternion.hpp>

namespace patina {

glm::dvec2 distort(const Intrinsics& camera, glm::dvec2 point) {
    const auto [k1, k2, p1, p2, k3] = camera.distortion;
    const double x = point.x, y = point.y;
    const double r2 = x * x + y * y;
    const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
    return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

glm::dvec2 project(const Intrinsics& camera, glm::dvec3 point_m) {
    const glm::dvec2 normalised = distort(camera, glm::dvec2(point_m) / point_m.z);
    return {normalised.x * camera.fx + camera.cx, normalised.y * camera.fy + camera.cy};
}

Intrinsics scaled_to(const Intrinsics& camera, Extent2D extent) {
    const double sx = static_cast<double>(extent.width) / camera.extent.width;
    const double sy = static_cast<double>(extent.height) / camera.extent.height;
    Intrinsics scaled = camera;
    scaled.extent = extent;
    scaled.fx *= sx;
    scaled.fy *= sy;
    scaled.cx = (camera.cx + 0.5) * sx - 0.5;
    scaled.cy = (camera.cy + 0.5) * sy - 0.5;
    return scaled;
}

RigidTransform rigid_inverse(const RigidTransform& transform) {
    const glm::dmat3 rotation = glm::transpose(glm::dmat3(transform));
    RigidTransform inverse(rotation);
    inverse[3] = glm::dvec4(-(rotation * glm::dvec3(transform[3])), 1.0);
    return inverse;
}

RigidTransform orthonormalised(const RigidTransform& transform) {
    // Newton's iteration for the polar decomposition converges to the nearest rotation; recorded poses are off by about
    // 1e-3, so that five quadratic steps reach double precision.
    glm::dmat3 rotation(transform);
    for (int step = 0; step < 5; ++step) rotation = 0.5 * (rotation + glm::transpose(glm::inverse(rotation)));
    RigidTransform result(rotation);
    result[3] = glm::dvec4(glm::dvec3(transform[3]), 1.0);
    return result;
}

double rotation_defect(const RigidTransform& transform) {
    double defect = 0;
    const glm::dmat3 rotation(transform);
    const glm::dmat3 product = glm::transpose(rotation) * rotation;
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            if (!std::isfinite(transform[column][row])) return std::numeric_limits<double>::infinity();
            if (column < 3 && row < 3) {
                defect = std::max(defect, std::abs(product[column][row] - (column == row ? 1.0 : 0.0)));
            }
        }
    }
    return glm::determinant(rotation) > 0 ? defect : std::max(defect, 2.0);
}

}  // namespace patina
