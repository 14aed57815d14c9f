#pragma once

#include <cstdint>
#include <optional>

#include "engine/graph/runner.h"
#include "passes/state/map_access.h"
#include "passes/state/voxel_map.h"
#include "patina/scene.h"
#include "shared/surface/extract_surface.h"

namespace patina {

/// How to extract; the mesh is the same whatever is set here.
struct SurfaceOptions {
    /// Vertices or triangles written at once, at least what one block can have (kMaxBlockElements); empty takes what
    /// the device's buffers hold.
    std::optional<uint32_t> batch_elements;
    std::optional<MapAccess> access;  ///< empty takes the faster one
};

inline constexpr uint32_t kMaxBlockElements = gpu::kBlockVoxels * gpu::kMaxCaseTriangles;

/// Device memory that extract_surface() takes for a block of the pool while it runs.
inline constexpr uint64_t kSurfaceBlockBytes = (gpu::kNeighbourStride + 4 * gpu::kBlockWords) * sizeof(uint32_t) +
                                               gpu::kBlockEdgeWords * sizeof(gpu::EdgeWord) +
                                               sizeof(gpu::BlockElements);

/// Marching cubes over the whole map, for the end of a recording: waits for the device several times.
/// A cell lies between eight voxel centres and counts where all of them have been seen; inside is a distance <= 0.
/// Vertices lie on the cells' edges where the linearly interpolated distance is zero, once for all cells around an
/// edge; all are used. Normals are interpolated gradients of the distance, colours the seen ones of an edge's ends.
/// The mesh is closed but where cells end, every triangle lies within one cell, and the order of vertices and
/// triangles follows the blocks' places alone: same map content, same bytes. Throws Error for a batch that is too
/// small, more than 2^32 - 1 vertices or triangles, or when memory runs out.
Mesh extract_surface(graph::Runner& runner, const VoxelMap& map, const SurfaceOptions& options = {});

}  // namespace patina
