#pragma once

#include "engine/graph/frame_graph.h"

namespace patina {

/// The connected components of a picture. Each is known by its key: 1 + y W + x of its first pixel.
struct Components {
    graph::ImageId component;  ///< W x H r32ui: the key, 0: none
    graph::BufferId pixels;    ///< u32 per key: how many pixels have it
    graph::BufferId parents;   ///< u32 by key - 1: disjoint sets (shaders/lib/math/disjoint_sets.glsl)
};

/// Labels connected components, with four neighbours, of the pixels whose `inner_depth_m` (W x H r32f) is above 0
/// and whose depths differ by at most jump_m + jump_slope times the larger one.
/// Union-find over runs (Komura 2015; Playne and Hawick 2018): the result does not depend on the order in which
/// invocations run. Throws Error for pictures of 2^31 pixels or more.
Components add_label_components(graph::FrameGraph& frame, graph::ImageId inner_depth_m, float jump_m, float jump_slope);

}  // namespace patina
