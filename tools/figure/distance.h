#pragma once

#include <algorithm>
#include <cmath>

#include <glm/glm.hpp>

// Signed distances to simple solids, negative inside, and how they are joined. All are smooth but for the seams that
// are wanted. Those of ellipsoids are first-order approximations: exact at 0, and steepest along the normal.
namespace patina::figure {

inline double ellipsoid(glm::dvec3 p, glm::dvec3 center, glm::dvec3 radii) {
    const glm::dvec3 scaled = (p - center) / radii;
    const double k = glm::length(scaled);
    if (k < 1e-9) return -std::min({radii.x, radii.y, radii.z});
    return k * (k - 1) / glm::length(scaled / radii);
}

inline double sphere(glm::dvec3 p, glm::dvec3 center, double radius) { return glm::distance(p, center) - radius; }

/// A rod from `a` to `b` with round ends whose radius goes from `radius_a` to `radius_b`.
inline double rod(glm::dvec3 p, glm::dvec3 a, glm::dvec3 b, double radius_a, double radius_b) {
    const double along = glm::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
    return glm::distance(p, glm::mix(a, b, along)) - glm::mix(radius_a, radius_b, along);
}

/// A ring around `axis` (unit length).
inline double torus(glm::dvec3 p, glm::dvec3 center, glm::dvec3 axis, double ring_radius, double radius) {
    const double height = glm::dot(p - center, axis);
    const double outward = glm::length(p - center - height * axis) - ring_radius;
    return std::hypot(outward, height) - radius;
}

/// The union of two solids, their seam filled over a width of about `blend` (Quilez' polynomial smooth minimum).
inline double join(double a, double b, double blend) {
    const double overlap = std::max(blend - std::abs(a - b), 0.0) / blend;
    return std::min(a, b) - overlap * overlap * blend / 4;
}

/// What is left of `a` without `b`, the rim rounded likewise.
inline double carve(double a, double b, double blend) { return -join(-a, b, blend); }

}  // namespace patina::figure
