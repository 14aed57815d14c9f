#pragma once

#include <optional>

#include "engine/graph/frame_graph.h"
#include "patina/frame.h"

namespace patina {

/// Uploads a colour picture and converts it to linear radiance as the pinhole camera with the same extent, fx, fy, cx
/// and cy would see it, interpolating bilinearly in linear light where the lens distorts. Negative radiance becomes 0.
/// Returns an rgba16f image, `target` where there is one, whose alpha says what rgb is worth
/// (shared/input/convert_color.h): kColorValid; kColorClipped where a source pixel that was used has a channel of 255,
/// or one beyond the range of half floats; kColorInvalid, and rgb 0, where a source pixel that was used is not finite
/// or the distorted picture does not show the pixel. Throws Error when the number of pixels or the intrinsics make no
/// sense.
graph::ImageId add_convert_color(graph::FrameGraph& frame, const ColorInput& input,
                                 std::optional<graph::ImageId> target = std::nullopt);

/// Throws Error when the intrinsics make no sense.
void check_color(const ColorInput& input);

}  // namespace patina
