#pragma once

#include "passes/tracking/track_level.h"

namespace patina {

/// How frame and model are compared.
struct TrackErrors {
    /// A reading scatters by noise_floor_m + noise_per_m z^2. More than the sensor's own noise: what model and
    /// association add.
    float noise_floor_m = 0.002f;
    float noise_per_m = 0.0005f;  ///< 1 / m
    float robust_sigmas = 4;      ///< a pair so far apart has a quarter of its weight, on the finest level
    float gate_m = 0.02f;         ///< on the finest level pairs farther apart than gate_m + gate_slope z are none;
    float gate_slope = 0.01f;     ///< both, and robust_sigmas, double from level to level
    float shade_sigma = 0.1f;     ///< of a difference of shade, which is 0 to 1; 0: shades are not compared
    float robust_shade = 0.1f;    ///< a difference so large has a quarter of its weight
};

/// Sums of one iteration.
struct NormalEquations {
    graph::BufferId sums;  ///< f32 [groups][gpu::kTrackSums]
    uint32_t groups = 0;
};

/// Compares one level of a frame with the same one of the model under the pose in `state` (gpu::TrackState). `coarser`
/// says how many levels are finer than this one. Throws Error when a setting is not positive.
NormalEquations add_normal_equations(graph::FrameGraph& frame, const TrackLevel& own, const TrackLevel& model,
                                     graph::BufferId state, const TrackErrors& errors, uint32_t coarser);

/// Moves the pose in `state` by the solution of the equations. Directions whose eigenvalue is less than `held_share`
/// of the mean weight are held. With pairs of less weight than `least_pairs` the pose stays and `solutions` becomes 0.
/// Returns the next version of the state.
graph::BufferId add_solve_motion(graph::FrameGraph& frame, const NormalEquations& equations, graph::BufferId state,
                                 float held_share, float least_pairs);

}  // namespace patina
