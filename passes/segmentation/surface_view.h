#pragma once

#include "engine/graph/frame_graph.h"

namespace patina {

/// The map's surface as one camera sees it, and where to look for its blocks.
struct SurfaceView {
    graph::ImageId position_m;  ///< W x H rgba32f: world; w is 0 where nothing was hit
    graph::ImageId normal;      ///< W x H rgba16f: world, unit length; 0 where it is not known
    graph::BufferId view;       ///< gpu::ViewParams of the camera
    graph::BufferId view_grid;  ///< u32 per block of the box around the view: block id, or gpu::kNoBlock
    graph::BufferId blocks;     ///< u32: count of the visible blocks, then their ids in no order
};

}  // namespace patina
