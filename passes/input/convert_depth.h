#pragma once

#include <optional>

#include "engine/graph/frame_graph.h"
#include "patina/frame.h"

namespace patina {

/// Uploads a depth picture and converts it to metres as the pinhole camera with the same extent, fx, fy, cx and cy
/// would measure them. Where the lens distorts, a pixel takes the nearest source pixel: depth must not be interpolated.
/// Returns an r32f image, `target` where there is one; 0 where there is no reading, where it lies beyond max_metres, or
/// where the distorted picture does not show the pixel. Throws Error when the number of pixels, the intrinsics or the
/// scale make no sense.
graph::ImageId add_convert_depth(graph::FrameGraph& frame, const DepthInput& input,
                                 std::optional<graph::ImageId> target = std::nullopt);

/// Throws Error when the intrinsics or the scale make no sense.
void check_depth(const DepthInput& input);

}  // namespace patina
