#include "passes/tracking/judge_motion.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <glm/gtc/quaternion.hpp>

#include "engine/core/error.h"
#include "shared/tracking/tracking.h"

namespace patina {

namespace {

double angle_degrees(const RigidTransform& transform) {
    const double trace = transform[0][0] + transform[1][1] + transform[2][2];
    return glm::degrees(std::acos(std::clamp((trace - 1) / 2, -1.0, 1.0)));
}

/// Keeps the worst state, and why it is so bad.
class Verdict {
  public:
    explicit Verdict(TrackingReport& report) : report_(report) { report_.state = TrackingState::kTracking; }

    template <class... Parts>
    void demand(bool met, TrackingState otherwise, const Parts&... reason) {
        if (met || otherwise <= report_.state) return;
        report_.state = otherwise;
        report_.reason = text(reason...);
    }

  private:
    TrackingReport& report_;
};

}  // namespace

const char* name_of(TrackingState state) {
    switch (state) {
        case TrackingState::kTracking: return "tracking";
        case TrackingState::kWeak: return "weak";
        case TrackingState::kLost: return "lost";
    }
    return "?";
}

RigidTransform reference_from_frame(const gpu::TrackState& state) {
    const glm::dvec4 q(state.rotation);
    RigidTransform transform = glm::mat4_cast(glm::normalize(glm::dquat(q.w, q.x, q.y, q.z)));
    transform[3] = glm::dvec4(glm::dvec3(state.translation_m), 1);
    return transform;
}

TrackingReport judge_motion(const gpu::TrackState& state, const RigidTransform& predicted,
                            const TrackingBounds& bounds) {
    TrackingReport report;
    const RigidTransform motion = rigid_inverse(predicted) * reference_from_frame(state);
    report.share = state.readings > 0 ? state.pairs / state.readings : 0;
    report.sigmas = state.sigmas;
    report.shade_error = state.shade_error;
    report.least_eigenvalue = state.eigenvalues_low.x;
    report.held = static_cast<uint32_t>(state.held);
    report.mean_depth_m = state.mean_depth_m;
    report.gain = state.gain;
    report.motion_m = glm::length(glm::dvec3(motion[3]));
    report.motion_degrees = angle_degrees(motion);
    const double step_degrees = glm::degrees(static_cast<double>(state.step_rad));
    const bool solved = state.solutions > 0 && state.pairs >= static_cast<float>(bounds.least_pairs) &&
                        std::isfinite(report.motion_m) && std::isfinite(report.motion_degrees);

    using enum TrackingState;
    Verdict verdict(report);
    verdict.demand(solved, kLost, "only ", std::lround(state.pairs), " of ", std::lround(state.readings),
                   " readings lie on the model");
    verdict.demand(report.share >= bounds.lost_share, kLost, std::lround(100 * report.share),
                   " % of the readings lie on the model");
    verdict.demand(report.sigmas <= bounds.lost_sigmas, kLost, "the readings are ", report.sigmas,
                   " sigmas off the model");
    verdict.demand(report.motion_m <= bounds.lost_motion_m, kLost, "the pose is ", report.motion_m,
                   " m from where it was expected");
    verdict.demand(report.motion_degrees <= bounds.lost_motion_degrees, kLost, "the pose is turned by ",
                   report.motion_degrees, " degrees from where it was expected");
    verdict.demand(report.held == 0, kWeak, "the view leaves ", report.held, " directions of motion open");
    verdict.demand(report.share >= bounds.weak_share, kWeak, std::lround(100 * report.share),
                   " % of the readings lie on the model");
    verdict.demand(report.sigmas <= bounds.weak_sigmas, kWeak, "the readings are ", report.sigmas,
                   " sigmas off the model");
    verdict.demand(state.step_m <= bounds.weak_step_m && step_degrees <= bounds.weak_step_degrees, kWeak,
                   "the pose did not settle: the last iteration moved it by ", state.step_m, " m and ", step_degrees,
                   " degrees");
    return report;
}

}  // namespace patina
