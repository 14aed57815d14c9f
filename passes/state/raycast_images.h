#pragma once

#include "engine/graph/frame_graph.h"

namespace patina {

/// The surface as one camera sees it.
struct RaycastImages {
    graph::ImageId
        position_m;  ///< W x H rgba32f: world; w is the depth along the optical axis, 0 where nothing was hit
    graph::ImageId
        normal;  ///< W x H rgba16f: world, unit length, towards free space; 0 where nothing was hit or seen around
};

}  // namespace patina
