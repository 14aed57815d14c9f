#pragma once

#include <string>

#include "patina/camera.h"
#include "patina/reconstruction.h"

namespace patina {

namespace gpu {
struct TrackState;
}

const char* name_of(TrackingState state);

/// What the states depend on. A pose that fails a weak bound is weak, one that fails a lost bound is lost.
struct TrackingBounds {
    uint32_t least_pairs = 500;  ///< pixels of the finest level used, by weight, that lie on the model; fewer: lost
    float weak_share = 0.4f;     ///< of the readings that lie on the model, by weight
    float lost_share = 0.2f;
    float weak_sigmas = 2.5f;  ///< root mean square distance of these, in sigmas of the sensor
    float lost_sigmas = 4;
    float held_share = 0.002f;   ///< eigenvalue of the normal equations over the sum of weights, the mean squared
                                 ///< share by which a motion moves the surface along its normal; below: weak, and
                                 ///< the pose is held in that direction
    float weak_step_m = 0.002f;  ///< of the last iteration: it has not settled
    float weak_step_degrees = 0.1f;
    float jump_share = 0.5f;     ///< of a frame's readings that must lie on the model to be found again after a loss
    float lost_motion_m = 0.3f;  ///< from the predicted pose
    float lost_motion_degrees = 20;
};

/// What one search for a frame's pose found, in figures.
struct TrackingFigures {
    TrackingState state = TrackingState::kLost;
    RigidTransform world_from_depth{1.0};  ///< of a lost frame: where it was expected
    double share = 0;                      ///< of the readings that lie on the model, by weight
    double sigmas = 0;                     ///< root mean square distance in sigmas of the sensor
    double shade_error = 0;                ///< root mean square difference of shade; 0 without any
    double least_eigenvalue = 0;           ///< over the sum of weights
    uint32_t held = 0;                     ///< directions that were held
    double motion_m = 0;                   ///< from the predicted pose
    double motion_degrees = 0;
    float mean_depth_m = 2;  ///< of the readings
    float gain = 1;          ///< the frame's shades times this are the model's
};

/// The same with why it is not tracking, in a few words; empty where it is.
struct TrackingReport : TrackingFigures {
    std::string reason;
};

/// The pose that a state stands for: reference_from_frame.
RigidTransform reference_from_frame(const gpu::TrackState& state);

/// Judges a search that ended in `state` and started from `predicted`, both relative to the reference. Everything but
/// the report's pose is filled in.
TrackingReport judge_motion(const gpu::TrackState& state, const RigidTransform& predicted,
                            const TrackingBounds& bounds);

}  // namespace patina
