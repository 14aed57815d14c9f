#pragma once

#include <span>

#include "passes/kinect2/tables.h"
#include "patina/frame.h"
#include "shared/kinect2/register_color.h"

namespace patina::kinect2 {

inline constexpr Extent2D kColorExtent{gpu::kColorWidth, gpu::kColorHeight};

/// The colour of each pixel of `depth_m` (add_undistort_depth), from the nearest pixel of the colour picture, by the
/// device's own polynomials. `color`: 1920 x 1080, mirrored back. Returns 512 x 424 r32ui: r | g << 8 | b << 16 |
/// 255 << 24; 0 where there is no reading, where the colour picture does not show it, and where something that is
/// nearer by more than 1 % hides it from the colour camera. Throws Error when the picture has another size.
graph::ImageId add_register_color(graph::FrameGraph& frame, const Tables& tables, const TableIds& ids,
                                  graph::ImageId depth_m, std::span<const SrgbPixel> color);

}  // namespace patina::kinect2
