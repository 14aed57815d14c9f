#include "export/trajectory.h"

#include <cmath>
#include <iterator>

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include "engine/core/error.h"

namespace patina {
namespace {

/// Poses come from double arithmetic and files of six or more digits; a larger defect is a mistake, not rounding.
constexpr double kLargestRotationDefect = 1e-3;

void check_pose(const TimedPose& pose, size_t index) {
    const double defect = rotation_defect(pose.world_from_camera);
    if (!std::isfinite(pose.timestamp_s) || !std::isfinite(defect)) {
        throw Error("trajectory: pose ", index, " at ", pose.timestamp_s, " s is not finite");
    }
    if (defect > kLargestRotationDefect) {
        throw Error("trajectory: pose ", index, " is no rotation: its defect is ", defect, ", at most ",
                    kLargestRotationDefect, " is allowed");
    }
}

/// Of the two quaternions of one rotation, that whose last component that is not zero as printed is positive.
glm::dquat with_canonical_sign(glm::dquat q) {
    constexpr double kPrintsAsZero = 0.5e-9;
    for (double component : {q.w, q.z, q.y, q.x}) {
        if (std::abs(component) > kPrintsAsZero) return component < 0 ? -q : q;
    }
    return q;
}

/// `value` with `decimals` digits after the point, and no sign before a zero.
std::string fixed(double value, int decimals) {
    std::string text = fmt::format("{:.{}f}", value, decimals);
    if (text.find_first_not_of("-0.") == std::string::npos && text.front() == '-') text.erase(0, 1);
    return text;
}

}  // namespace

std::string trajectory_text(std::span<const TimedPose> poses) {
    constexpr int kDecimals = 6, kQuaternionDecimals = 9;
    std::string text = "# timestamp tx ty tz qx qy qz qw\n";
    for (size_t i = 0; i < poses.size(); ++i) {
        check_pose(poses[i], i);
        const RigidTransform& pose = poses[i].world_from_camera;
        const glm::dquat q = with_canonical_sign(glm::normalize(glm::quat_cast(glm::dmat3(pose))));
        text += fixed(poses[i].timestamp_s, kDecimals);
        for (double value : {pose[3].x, pose[3].y, pose[3].z}) text += ' ' + fixed(value, kDecimals);
        for (double value : {q.x, q.y, q.z, q.w}) text += ' ' + fixed(value, kQuaternionDecimals);
        text += '\n';
    }
    return text;
}

}  // namespace patina
