#pragma once

#include "engine/graph/frame_graph.h"
#include "shared/viewer/draw_layer.h"

namespace patina {

/// The surface that a layer is of; both W x H.
struct DrawnSurface {
    graph::ImageId position_m;  ///< rgba32f: world; w is 0 where nothing was hit
    graph::ImageId normal;      ///< rgba16f: world, unit length; 0 where it is not known
};

/// Draws a layer into `picture`, which is replaced as a whole: W x H rgba8, encoded for sRGB, a = 1. `value` is W x H
/// rgba16f; a > 0 says that it is known. Normals are the surface's own, and `value` does not count. Where nothing was
/// hit the picture is dark, where the value is not known grey. Returns the written version, kept. Throws Error when the
/// images differ in extent.
graph::ImageId add_draw_layer(graph::FrameGraph& frame, const DrawnSurface& surface, graph::ImageId value,
                              const gpu::DrawLayerParams& params, graph::ImageId picture);

/// The same of segments: `label` is W x H r32ui, 0 where none is known. Of the parameters the camera alone counts.
graph::ImageId add_draw_segments(graph::FrameGraph& frame, const DrawnSurface& surface, graph::ImageId label,
                                 const gpu::DrawLayerParams& params, graph::ImageId picture);

}  // namespace patina
