#pragma once

#include "engine/graph/frame_graph.h"

namespace patina {

/// A frame as ferns look at it, 40 x 30 rgba32f: rgb the square root of linear colour, -1 where it is not known; a the
/// depth in metres, 0 where it is not known. A pixel is the mean over its box of the frame where a quarter of that is
/// valid, then these are smoothed by a Gaussian of sigma 2.5 px (Glocker et al. 2015) over what is valid, where that is
/// half of the weight. `depth_m`: r32f, 0 where there is no reading. `color`: rgba16f (add_convert_color), clipped
/// pixels count. Their extents may differ, and may be below 40 x 30.
graph::ImageId add_shrink_frame(graph::FrameGraph& frame, graph::ImageId depth_m, graph::ImageId color);

/// The fern code of a frame: u32[gpu::kFernWords], four ferns a word (shared/tracking/keyframes.h). `small` comes from
/// add_shrink_frame; `ferns`: gpu::Fern[gpu::kFerns]. Throws Error when `small` is not 40 x 30 pixels.
graph::BufferId add_encode_frame(graph::FrameGraph& frame, graph::ImageId small, graph::BufferId ferns);

}  // namespace patina
