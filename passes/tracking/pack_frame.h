#pragma once

#include <optional>

#include "passes/tracking/track_level.h"

namespace patina {

/// A frame's colours, and where they were taken.
struct TrackColor {
    graph::ImageId color_linear;  ///< rgba16f (add_convert_color)
    Intrinsics camera;
    RigidTransform color_from_depth{1.0};
};

/// Packs a frame for tracking: the readings of `depth_m` (W x H r32f, metres, 0 where there is none), seen by `camera`,
/// up to max_depth_m, with the shade that the colour camera sees there. Readings beside a jump are left out. Without
/// colours there are no shades. Returns W x H r32ui; with `half` W / 2 x H / 2, means of 2 x 2 readings as
/// add_halve_frame takes them, with the shade at the mean point. Throws Error when an image is not its camera's size,
/// or the result would be empty.
TrackLevel add_pack_frame(graph::FrameGraph& frame, graph::ImageId depth_m, const Intrinsics& camera,
                          const std::optional<TrackColor>& color, float max_depth_m, bool half = false,
                          const TrackJump& jump = {});

/// The next coarser level: means of 2 x 2 readings, none where two are missing or lie on different surfaces. Throws
/// Error when the result would be empty.
TrackLevel add_halve_frame(graph::FrameGraph& frame, const TrackLevel& fine, const TrackJump& jump = {});

}  // namespace patina
