#pragma once

#include <optional>

#include "passes/state/raycast_images.h"
#include "passes/tracking/track_level.h"
#include "shared/input/camera.h"

namespace patina {

/// What a camera sees of the model, as the tracker compares frames with it.
struct TrackModelInputs {
    RaycastImages surface;                       ///< W x H, world
    std::optional<graph::ImageId> color_linear;  ///< W x H rgba16f, a = 0 where there is none (add_shade_color)
    gpu::Camera camera;                          ///< that saw both
};

/// Packs the model for tracking into `target`, W x H rgba32ui: depth, normal in camera coordinates, shade and how the
/// shade changes per pixel. Surfaces seen at more than 80 degrees are left out; without colours there are no shades.
/// Into a target of W / 2 x H / 2 go the means that add_halve_model takes. Returns the written version. Throws Error
/// when images are of other extents.
graph::ImageId add_pack_model(graph::FrameGraph& frame, const TrackModelInputs& inputs, graph::ImageId target,
                              const TrackJump& jump = {});

/// The next coarser level into `target`, half as wide and high: means of 2 x 2 pixels, nothing where one of them has
/// nothing or they lie on different surfaces. Returns the written version. Throws Error when `target` is of another
/// size.
graph::ImageId add_halve_model(graph::FrameGraph& frame, graph::ImageId fine, graph::ImageId target,
                               const TrackJump& jump = {});

}  // namespace patina
