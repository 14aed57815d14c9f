#pragma once

#include <optional>

#include "passes/state/observation_map.h"
#include "patina/camera.h"

namespace patina {

/// How the colour camera moved while its shutter was open.
struct CameraMotion {
    glm::mat4 color_before_from_world{1.0f};  ///< the colour camera at the frame before
    float shutter_share = 0;                  ///< of the time since then, that the shutter was open
};

/// What counts as an observation.
struct ObservationSettings {
    uint32_t stride_px = 2;        ///< every so many pixels look for voxels to observe, another phase in every frame
    float max_distance_m = 8.0f;   ///< farther surface is not observed
    float max_angle_degrees = 80;  ///< between the normal and the direction to the colour camera
    /// How far a reading may lie off the model's surface: the first, plus the second times depth^2, three times a time
    /// of flight camera's noise.
    float depth_tolerance_m = 0.01f;
    float depth_tolerance_per_m2 = 0.003f;
    uint32_t edge_margin_px = 2;    ///< colours this near to an edge of the depth image may be another surface's
    float merge_angle_degrees = 1;  ///< directions this near are the same observation: its samples are averaged
    /// Where motion smears the picture by more, it is not observed. Less than a voxel of 2 cm is wide at 2 m; a limit
    /// of 1 refuses half of what a hand-held Kinect sees.
    float max_blur_px = 3;
    /// Voxels with fewer observations take smeared ones, too: they know a colour, if not its print. How long the
    /// shutter was open is a guess in many recordings, and in those of few pictures a second all would seem smeared.
    uint32_t smeared_observations = 4;
    /// Where the camera moved so little since the frame before, by points at 1 m, it sees what it saw: a quarter of the
    /// pixels look.
    float rest_px = 0.5f;
};

/// The parameters that one frame's passes share; phases and stamps follow from the frame's index. The colour camera may
/// be the depth camera; without `motion` pictures are sharp. Throws Error when a setting is out of its range.
gpu::ObservationParams make_observation_params(const ObservationMap& map, const ObservationSettings& settings,
                                               const gpu::Camera& depth_camera, const gpu::Camera& color_camera,
                                               uint32_t frame_index, const std::optional<CameraMotion>& motion = {});

}  // namespace patina
