#pragma once

#include "engine/graph/frame.h"
#include "passes/fusion/visible_blocks.h"
#include "passes/model/map_access.h"
#include "passes/model/raycast_images.h"
#include "passes/model/voxel_map.h"

namespace patina {

/// Casts a ray per pixel of `visible`'s camera to the first zero crossing from seen free space into the inside.
RaycastImages add_raycast(graph::Frame& frame, const VoxelMap& map, const VoxelMapIds& ids,
                          const VisibleBlocks& visible, MapAccess access);

}  // namespace patina
