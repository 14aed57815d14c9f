#pragma once

#include "engine/graph/frame_graph.h"
#include "scenes/render/render.h"

namespace patina::scenes {

/// Turns rendered depth into a depth camera's readings: at a depth edge (a neighbour of four whose depth differs by
/// more than 3 % of the nearer one) the share `flying_pixels` of the pixels shows a depth drawn evenly between its own
/// and that neighbour's; to every depth z a Gaussian of sigma = depth_constant_m + depth_quadratic_per_m (z -
/// depth_offset_m)^2 is added; the sum is rounded to units of `metres_per_unit`. Returns one u32 per pixel, row by row:
/// units | object id << 16. Depth that ends up outside 0 .. 65535 units becomes 0, 'no reading', as does what was not
/// seen; object ids stay true. Without noise this is rounding alone.
graph::BufferId add_encode_depth(graph::FrameGraph& frame, const RenderedImages& rendered, double metres_per_unit,
                                 const SensorNoise& noise, const NoiseKey& key);

/// Turns rendered radiance L into what a colour camera's sensor holds: v = exposure L, plus a Gaussian of variance
/// color_read^2 + color_shot v in each channel; below 0 becomes 0, nothing is clipped above. Returns W x H rgba32f; a
/// is the radiance's.
graph::ImageId add_expose_color(graph::FrameGraph& frame, graph::ImageId radiance, double exposure,
                                const SensorNoise& noise, const NoiseKey& key);

/// Encodes linear colour as 8-bit sRGB (IEC 61966-2-1), clipped at 255. Returns one u32 per pixel, row by row:
/// r | g << 8 | b << 16.
graph::BufferId add_encode_color(graph::FrameGraph& frame, graph::ImageId linear_color);

}  // namespace patina::scenes
