#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "sensor/pose.h"
#include "tools/eval/result.h"

namespace patina::eval {

/// A camera's true pose and the run's at one time, both world_from_camera, each in its own world.
struct PosePair {
    size_t index = 0;  ///< of the true pose in its trajectory
    double timestamp_s = 0;
    RigidTransform truth{1.0};
    RigidTransform run{1.0};
};

/// The true poses that have one of the run at their time, at most `limit_s` apart, in the order of `truth`.
std::vector<PosePair> pair_poses(std::span<const sensor::StampedPose> truth, std::span<const sensor::StampedPose> run,
                                 double limit_s);

/// The rigid transform without scale that brings the run's positions nearest to the true ones in the least squares
/// sense (Umeyama, Least-Squares Estimation of Transformation Parameters Between Two Point Patterns, PAMI 1991).
RigidTransform align_positions(std::span<const PosePair> pairs);

/// truth_from_run of the worlds, from positions and orientations: unlike align_positions it is well defined for a
/// camera that rests or moves along a line. The rotation is that nearest to the mean of all pairs'.
RigidTransform align_worlds(std::span<const PosePair> pairs);

/// ATE and RPE of the pairs, at least one; times rise. `truth_poses` and `run_poses` are copied.
TrajectoryErrors trajectory_errors(std::span<const PosePair> pairs, size_t truth_poses, size_t run_poses);

}  // namespace patina::eval
