#pragma once

#include "engine/graph/frame_graph.h"

namespace patina {

/// Stands for a frame's or the model's colours where there are none: one black pixel, rgba16f.
graph::ImageId no_color(graph::FrameGraph& frame);

}  // namespace patina
