#pragma once

#include "engine/graph/frame.h"
#include "passes/fusion/visible_blocks.h"
#include "passes/model/map_access.h"
#include "passes/model/voxel_map.h"

namespace patina {

/// The surface as one camera sees it.
struct RaycastImages {
    graph::ImageId
        position_m;  ///< W x H rgba32f: world; w is the depth along the optical axis, 0 where nothing was hit
    graph::ImageId
        normal;  ///< W x H rgba16f: world, unit length, towards free space; 0 where nothing was hit or seen around
};

/// Casts a ray per pixel of `visible`'s camera to the first zero crossing from seen free space into the inside.
RaycastImages add_raycast(graph::Frame& frame, const VoxelMap& map, const VoxelMapIds& ids,
                          const VisibleBlocks& visible, MapAccess access);

}  // namespace patina
