#pragma once

#include <array>
#include <optional>

#include "patina/camera.h"
#include "patina/image.h"

namespace patina::reference {

/// A reading of a frame; depth 0: none; shade below 0: none.
struct TrackReading {
    double depth_m = 0;
    double shade = -1;
};

/// A pixel of the model, in camera coordinates.
struct TrackSurface {
    double depth_m = 0;
    glm::dvec3 normal{0, 0, -1};
    glm::dvec2 shade_per_px{0};
    double shade = -1;
};

/// A colour picture (linear; a as the alpha of add_convert_color) with its camera and place.
struct TrackPicture {
    Image<glm::vec4> linear;
    Intrinsics camera;
    RigidTransform color_from_depth{1.0};
};

/// Depths that differ by at most floor_m + slope z belong to one surface.
struct TrackJump {
    double floor_m = 0.01;
    double slope = 0.015;
};

/// What add_pack_frame computes, without its rounding; `half`: means of 2 x 2.
Image<TrackReading> pack_frame(const Image<float>& depth_m, const Intrinsics& camera,
                               const std::optional<TrackPicture>& color, double max_depth_m, bool half = false,
                               const TrackJump& jump = {});
Image<TrackReading> halve_frame(const Image<TrackReading>& fine, const TrackJump& jump = {});

/// What add_pack_model computes from world positions (w: depth), world normals and colours (a = 0: none).
Image<TrackSurface> pack_model(const Image<glm::vec4>& position_m, const Image<glm::vec4>& normal,
                               const std::optional<Image<glm::vec4>>& color, const Intrinsics& camera,
                               const RigidTransform& world_from_camera, const TrackJump& jump = {});
Image<TrackSurface> halve_model(const Image<TrackSurface>& fine, const TrackJump& jump = {});

/// How frame and model are compared; as passes/tracking/normal_equations.h says.
struct TrackComparison {
    double noise_floor_m = 0.002, noise_per_m = 0.0005;
    double robust_sigmas = 4, gate_m = 0.02, gate_slope = 0.01;
    double shade_sigma = 0, robust_shade = 0.1;
};

/// Where the frame's camera is, relative to the model's, and what rotations turn around.
struct TrackPose {
    RigidTransform model_from_frame{1.0};
    double gain = 1, center_m = 2, lever_m = 1;
};

struct TrackEquations {
    std::array<std::array<double, 6>, 6> matrix{};
    std::array<double, 6> right{};
    double readings = 0, pairs = 0, squares = 0, weight = 0, depth = 0;
    double shades = 0, shade_squares = 0, shade_product = 0, shade_own = 0;
};

/// The sums of one iteration, in double precision.
TrackEquations track_equations(const Image<TrackReading>& frame, const Intrinsics& frame_camera,
                               const Image<TrackSurface>& model, const Intrinsics& model_camera, const TrackPose& pose,
                               const TrackComparison& comparison);

struct TrackStep {
    RigidTransform model_from_frame{1.0};
    std::array<double, 6> eigenvalues{};  ///< over the sum of weights, ascending
    int held = 0;
};

/// The pose moved by the equations' solution; along eigenvectors of smaller eigenvalues than `held_share` it stays.
TrackStep track_step(const TrackEquations& equations, const TrackPose& pose, double held_share);

}  // namespace patina::reference
