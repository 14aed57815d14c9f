#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/fusion/visible_blocks.h"
#include "passes/state/map_access.h"
#include "passes/state/raycast_images.h"
#include "passes/state/voxel_map.h"

namespace patina {

/// Casts a ray per pixel of `visible`'s camera to the first zero crossing from seen free space into the inside, or from
/// space that nobody saw into a surface that faces the ray; such a hit has no normal.
RaycastImages add_raycast(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& ids,
                          const VisibleBlocks& visible, MapAccess access);

}  // namespace patina
