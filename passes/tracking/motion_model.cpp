#include "passes/tracking/motion_model.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

namespace patina {

namespace {

constexpr double kFrame_s = 1.0 / 30;
constexpr double kLongest_s = 1;  // farther ahead a motion says nothing

/// Axis times angle of a rotation.
glm::dvec3 rotation_vector(const RigidTransform& transform) {
    glm::dquat q = glm::normalize(glm::quat_cast(glm::dmat3(transform)));
    if (q.w < 0) q = -q;
    const glm::dvec3 axis(q.x, q.y, q.z);
    const double sine = glm::length(axis);
    return sine < 1e-12 ? glm::dvec3(0) : axis * (2 * std::atan2(sine, q.w) / sine);
}

RigidTransform moved(const glm::dvec3& way_m, const glm::dvec3& turn_rad) {
    const double angle = glm::length(turn_rad);
    RigidTransform transform(1.0);
    if (angle > 1e-12) transform = glm::rotate(transform, angle, turn_rad / angle);
    transform[3] = glm::dvec4(way_m, 1);
    return transform;
}

}  // namespace

double MotionModel::seconds_since_last(double timestamp_s) const {
    const double since_s = timestamp_s - last_time_.timestamp_s;
    return since_s > 0 ? std::min(since_s, kLongest_s) : kFrame_s;
}

std::vector<RigidTransform> MotionModel::expected(const FrameTime& time) const {
    std::vector<RigidTransform> poses;
    if (time.prior && last_time_.prior) {
        poses.push_back(orthonormalised(last_ * rigid_inverse(*last_time_.prior) * *time.prior));
    }
    // After a loss each frame more would damp again: the whole way is as likely.
    const double ahead_s = seconds_since_last(time.timestamp_s) * (lost_ ? 1 : damping_);
    const bool moving = velocity_m_s_ != glm::dvec3(0) || turning_rad_s_ != glm::dvec3(0);
    if (moving) poses.push_back(last_ * moved(velocity_m_s_ * ahead_s, turning_rad_s_ * ahead_s));
    poses.push_back(last_);
    return poses;
}

void MotionModel::note(const RigidTransform& pose, const FrameTime& time) {
    const double since_s = seconds_since_last(time.timestamp_s);
    const RigidTransform motion = rigid_inverse(last_) * pose;
    jump_to(pose, time);
    velocity_m_s_ = glm::dvec3(motion[3]) / since_s;
    turning_rad_s_ = rotation_vector(motion) / since_s;
}

void MotionModel::jump_to(const RigidTransform& pose, const FrameTime& time) {
    last_ = pose;
    last_time_ = time;
    velocity_m_s_ = turning_rad_s_ = glm::dvec3(0);
    lost_ = false;
}

}  // namespace patina
