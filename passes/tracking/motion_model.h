#pragma once

#include <optional>
#include <vector>

#include "patina/frame.h"

namespace patina {

/// Expects a camera to move on as it did before, a little slower, and after a loss as it did before that.
class MotionModel {
  public:
    /// `damping`, 0 to 1: the share of the last motion that is expected to go on.
    explicit MotionModel(double damping) : damping_(damping) {}

    /// Where the camera may be at a time, the likeliest first: by the prior, by the motion so far, at rest. Not to be
    /// called before a pose was noted.
    std::vector<RigidTransform> expected(const FrameTime& time) const;

    /// Notes a pose that was found: world_from_camera. Times that do not grow count as 1 / 30 s apart.
    void note(const RigidTransform& pose, const FrameTime& time);

    /// Notes that no pose was found.
    void note_loss() { lost_ = true; }

    /// Takes a pose over without a motion towards it.
    void jump_to(const RigidTransform& pose, const FrameTime& time);

  private:
    double seconds_since_last(double timestamp_s) const;

    double damping_;
    RigidTransform last_{1.0};
    FrameTime last_time_;
    glm::dvec3 velocity_m_s_{0};   ///< in the camera's axes
    glm::dvec3 turning_rad_s_{0};  ///< axis times angle
    bool lost_ = false;
};

}  // namespace patina
