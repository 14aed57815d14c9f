#include "engine/core/undistort.h"

namespace patina {

namespace {

/// The derivatives of distort() by x and by y, as columns.
glm::dmat2 jacobian(const Intrinsics& camera, glm::dvec2 p) {
    const auto [k1, k2, p1, p2, k3] = camera.distortion;
    const double r2 = glm::dot(p, p);
    const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const glm::dvec2 slope = 2.0 * p * (k1 + r2 * (2 * k2 + r2 * 3 * k3));
    const glm::dvec2 by_x(radial + p.x * slope.x + 2 * p1 * p.y + 6 * p2 * p.x,
                          p.y * slope.x + 2 * p1 * p.x + 2 * p2 * p.y);
    const glm::dvec2 by_y(p.x * slope.y + 2 * p1 * p.x + 2 * p2 * p.y,
                          radial + p.y * slope.y + 6 * p1 * p.y + 2 * p2 * p.x);
    return {by_x, by_y};
}

}  // namespace

std::optional<glm::dvec2> undistort(const Intrinsics& camera, glm::dvec2 distorted) {
    constexpr int kMaxSteps = 100;
    constexpr double kMaxError = 1e-12;  // a billionth of a pixel; rounding alone leaves less
    glm::dvec2 point = distorted;
    for (int i = 0; i < kMaxSteps; ++i) {
        const glm::dvec2 error = distort(camera, point) - distorted;
        if (glm::length(error) < kMaxError) return point;
        const glm::dmat2 slope = jacobian(camera, point);
        if (!(glm::determinant(slope) > 0)) return std::nullopt;  // folded back
        point -= glm::inverse(slope) * error;
    }
    return std::nullopt;
}

}  // namespace patina
