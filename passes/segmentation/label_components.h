#pragma once

#include "engine/graph/frame.h"

namespace patina {

/// Neighbours are connected where their depths differ by at most floor_m + relative z, z being the larger depth.
struct ConnectionLimit {
    float floor_m = 0.01f;
    float relative = 0.03f;
};

/// The connected components of a picture. A pixel's component is known by its first pixel in the order y * W + x.
struct Components {
    Extent2D extent;
    graph::BufferId words;    ///< gpu::RunWord per 32 pixels of a row
    graph::BufferId parents;  ///< u32 per pixel: the component's first pixel; defined where a run starts
    graph::BufferId pixels;   ///< u32 per pixel: how many its component has, at its first pixel; else 0
};

/// Labels connected components, with four neighbours, of the pixels whose `inner_depth_m` (W x H r32f) is above 0.
/// Union-find over runs (Komura 2015; Playne and Hawick 2018): the result does not depend on the order in which
/// invocations run. Throws Error for pictures of 2^31 pixels or more.
Components add_label_components(graph::Frame& frame, graph::ImageId inner_depth_m, const ConnectionLimit& limit = {});

}  // namespace patina
