#pragma once

#include "engine/graph/frame.h"
#include "sensor/synthetic/render.h"

namespace patina::sensor {

/// Encodes rendered images as a recorded sequence holds them. Returns two u32 per pixel, row by row: 8-bit sRGB codes
/// r | g << 8 | b << 16 (clipped at 255), and depth in units of `metres_per_unit` | object id << 16. Depth beyond 65535
/// units becomes 0.
graph::BufferId add_encode_frame(graph::Frame& frame, const RenderedImages& rendered, double metres_per_unit);

}  // namespace patina::sensor
