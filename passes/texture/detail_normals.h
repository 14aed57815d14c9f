#pragma once

#include "passes/state/voxel_map.h"
#include "passes/texture/place_texels.h"

namespace patina {

/// What the volume's surface faces at each texel of a page, against the mesh's normal there: detail that a mesh with
/// few triangles lacks. From central differences of the distances around the texel's point, over two voxels.
/// `tangents`: vec4 by vertex; xyz is the direction of x in the world, w the sign of the third axis, as glTF has them.
/// Tiles are those of the whole page. Returns u32 by texel: packSnorm2x16 of x and y of a unit normal whose z is
/// towards free space; 0 where nothing is known, or the surface turns away by more than 60 degrees; gpu::kNoSurface
/// where no surface lies.
graph::BufferId add_detail_normals(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& voxels,
                                   const PlaceTexelsInputs& inputs, graph::BufferId tangents, Extent2D page);

/// A word of these as a unit normal; (0, 0, 0) where no surface lies.
glm::vec3 unpack_detail(uint32_t word);

}  // namespace patina
