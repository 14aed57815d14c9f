#include "tools/render/orbit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/core/error.h"
#include "export/upright.h"

namespace patina::tools {

namespace {

template <class Value>
Value median(std::vector<Value>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

glm::dvec3 position_of(const RigidTransform& pose) { return glm::dvec3(pose[3]); }

glm::dvec3 up_of(std::span<const RigidTransform> cameras) {
    if (const auto up = mean_up(cameras)) return *up;
    throw Error("an orbit needs to know where up is, but the up directions of ", cameras.size(), " cameras cancel out");
}

RigidTransform look_at(glm::dvec3 from_m, glm::dvec3 at_m, glm::dvec3 up) {
    const glm::dvec3 z = glm::normalize(at_m - from_m), x = glm::normalize(glm::cross(-up, z)), y = glm::cross(z, x);
    return {glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(z, 0), glm::dvec4(from_m, 1)};
}

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kFacingCosine = 0.7;                    // a camera within 45 degrees of the centre looks at it
constexpr double kLeastGap = std::numbers::pi / 2;       // a narrower one between such cameras counts as seen
constexpr double kBeyond = 10 * std::numbers::pi / 180;  // so far past the outermost of them things look the same

/// From which sides a centre was seen: angles from `middle - half` to `middle + half`.
struct SeenSides {
    double middle = 0, half = std::numbers::pi;
};

/// All but the largest gap between the angles, if that is large. Of no angle: all around.
SeenSides seen_sides(std::vector<double> angles) {
    if (angles.empty()) return {};
    std::ranges::sort(angles);
    double gap = angles.front() + kTurn - angles.back(), begin = angles.front();
    for (size_t i = 1; i < angles.size(); ++i) {
        if (angles[i] - angles[i - 1] <= gap) continue;
        gap = angles[i] - angles[i - 1];
        begin = angles[i];
    }
    if (gap < kLeastGap) return {};
    const double half = (kTurn - gap) / 2;
    return {std::remainder(begin + half, kTurn), std::min(half + kBeyond, std::numbers::pi)};
}

/// Where an orbit is after a part of its time. It begins at angle 0, or at the seen one next to it. It goes once
/// around, or there and back over the sides that were seen, slower where it turns.
double angle_at(const SeenSides& seen, double part) {
    if (seen.half >= std::numbers::pi) return kTurn * part;
    const double begin = std::asin(std::clamp(-seen.middle / seen.half, -1.0, 1.0));
    return seen.middle + seen.half * std::sin(begin + kTurn * part);
}

/// A direction across `up`.
glm::dvec3 across(glm::dvec3 up) {
    const glm::dvec3 other = std::abs(up.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
    return glm::normalize(glm::cross(up, other));
}

}  // namespace

glm::dvec3 median_point(std::span<const glm::vec3> points) {
    glm::dvec3 middle(0);
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        std::vector<float> values;
        values.reserve(points.size());
        for (const glm::vec3& point : points) values.push_back(point[axis]);
        middle[axis] = double{median(values)};
    }
    return middle;
}

std::vector<RigidTransform> orbit_poses(std::span<const RigidTransform> recorded, glm::dvec3 center_m, uint32_t count) {
    const glm::dvec3 up = up_of(recorded);
    const glm::dvec3 first = position_of(recorded.front()) - center_m, level = first - glm::dot(first, up) * up;
    const glm::dvec3 ahead = glm::length(level) > 1e-6 ? glm::normalize(level) : across(up);
    const glm::dvec3 aside = glm::cross(up, ahead);
    std::vector<double> radii, heights, sides;
    for (const RigidTransform& pose : recorded) {
        const glm::dvec3 offset = position_of(pose) - center_m;
        heights.push_back(glm::dot(offset, up));
        radii.push_back(glm::length(offset - heights.back() * up));
        if (glm::dot(glm::dvec3(pose[2]), -offset) > kFacingCosine * glm::length(offset))
            sides.push_back(std::atan2(glm::dot(offset, aside), glm::dot(offset, ahead)));
    }
    const SeenSides seen = seen_sides(std::move(sides));
    const double radius = std::max(median(radii), kLeastOrbit_m), height = median(heights);
    std::vector<RigidTransform> poses;
    for (uint32_t i = 0; i < count; ++i) {
        const double angle = angle_at(seen, static_cast<double>(i) / count);
        const glm::dvec3 outwards = std::cos(angle) * ahead + std::sin(angle) * aside;
        poses.push_back(look_at(center_m + radius * outwards + height * up, center_m, up));
    }
    return poses;
}

}  // namespace patina::tools
