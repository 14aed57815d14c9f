#include "tools/viewer/free_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace patina::tools {

namespace {

constexpr double kOrbit = 0.4 * std::numbers::pi / 180;  // radians a pixel
constexpr double kDolly = 1.2;

/// A direction across `up`.
glm::dvec3 across(glm::dvec3 up) {
    const glm::dvec3 other = std::abs(up.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
    return glm::normalize(glm::cross(up, other));
}

}  // namespace

void FreeCamera::set_up(glm::dvec3 up, glm::dvec3 forward) {
    up_ = glm::normalize(up);
    const glm::dvec3 level = -forward + glm::dot(forward, up_) * up_;
    ahead_ = glm::length(level) > 1e-6 ? glm::normalize(level) : across(up_);
    aside_ = glm::cross(up_, ahead_);
    azimuth_ = elevation_ = 0;
}

void FreeCamera::look_from(const RigidTransform& pose, double distance_m) {
    const glm::dvec3 forward(pose[2]), away = -forward;
    distance_m_ = std::clamp(distance_m, kLeastDistance_m, kMostDistance_m);
    pivot_m_ = glm::dvec3(pose[3]) + distance_m_ * forward;
    elevation_ = std::asin(std::clamp(glm::dot(away, up_), -1.0, 1.0));
    // Of a camera that looks straight up or down, its right says where it is turned to.
    const glm::dvec3 right_of(pose[0]);
    azimuth_ = std::abs(elevation_) < 1.5 ? std::atan2(glm::dot(away, aside_), glm::dot(away, ahead_))
                                          : std::atan2(-glm::dot(right_of, ahead_), glm::dot(right_of, aside_));
}

void FreeCamera::orbit(glm::dvec2 moved_px) {
    azimuth_ = std::remainder(azimuth_ - kOrbit * moved_px.x, 2 * std::numbers::pi);
    elevation_ = std::remainder(elevation_ + kOrbit * moved_px.y, 2 * std::numbers::pi);
}

void FreeCamera::pan(glm::dvec2 moved_px, double focal_px) {
    const RigidTransform at = pose();
    pivot_m_ -= (moved_px.x * glm::dvec3(at[0]) + moved_px.y * glm::dvec3(at[1])) * (distance_m_ / focal_px);
}

void FreeCamera::dolly(double steps) {
    distance_m_ = std::clamp(distance_m_ * std::pow(kDolly, -steps), kLeastDistance_m, kMostDistance_m);
}

void FreeCamera::look_along(AxisView view) {
    constexpr double kQuarter = std::numbers::pi / 2;
    elevation_ = view == AxisView::kTop ? kQuarter : view == AxisView::kBottom ? -kQuarter : 0;
    azimuth_ = view == AxisView::kRight  ? kQuarter
               : view == AxisView::kBack ? std::numbers::pi
               : view == AxisView::kLeft ? -kQuarter
                                         : 0;
}

void FreeCamera::opposite() {
    azimuth_ = std::remainder(azimuth_ + std::numbers::pi, 2 * std::numbers::pi);
    elevation_ = -elevation_;
}

glm::dvec3 FreeCamera::towards_camera() const {
    const glm::dvec3 level = std::cos(azimuth_) * ahead_ + std::sin(azimuth_) * aside_;
    return std::cos(elevation_) * level + std::sin(elevation_) * up_;
}

glm::dvec3 FreeCamera::right() const { return std::cos(azimuth_) * aside_ - std::sin(azimuth_) * ahead_; }

RigidTransform FreeCamera::pose() const {
    const glm::dvec3 away = towards_camera(), x = right(), z = -away, y = glm::cross(z, x);
    return {glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(z, 0), glm::dvec4(pivot_m_ + distance_m_ * away, 1)};
}

Intrinsics with_extent(const Intrinsics& field_of, Extent2D extent) {
    const double scale = static_cast<double>(extent.height) / field_of.extent.height;
    const auto moved = [&](double center, uint32_t from, uint32_t to) {
        return (center + 0.5 - 0.5 * from) * scale + 0.5 * to - 0.5;
    };
    Intrinsics camera;
    camera.extent = extent;
    camera.fx = field_of.fx * scale;
    camera.fy = field_of.fy * scale;
    camera.cx = moved(field_of.cx, field_of.extent.width, extent.width);
    camera.cy = moved(field_of.cy, field_of.extent.height, extent.height);
    return camera;
}

}  // namespace patina::tools
