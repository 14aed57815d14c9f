#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

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

/// A part of the map: the blocks whose coordinates lie between two corners, both included.
struct SurfacePart {
    /// How many blocks beside it, along each axis, a part's triangles depend on: they reach into the next block, whose
    /// vertices depend on that after it.
    static constexpr int kBelow = 1, kAbove = 2;
    glm::ivec3 low{0}, high{0};

    bool holds(glm::ivec3 block) const {
        return glm::all(glm::lessThanEqual(low, block)) && glm::all(glm::lessThanEqual(block, high));
    }
};

/// A block that owns vertices or triangles of the surface.
struct SurfaceElements {
    uint32_t key = 0;
    gpu::BlockElements own{};
    gpu::BlockElements before{};  ///< of all blocks with smaller keys
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

/// For a map that the device does not hold at once, which has to be there part by part, each with the blocks beside it:
/// first what the blocks of each part own, then, when all were counted, the elements of each part. These stand in the
/// order of keys; triangles hold the vertices' numbers in the whole mesh. Wait and throw as extract_surface() does.
std::vector<SurfaceElements> count_surface(graph::Runner& runner, const VoxelMap& map, const SurfacePart& part);
/// Sorts by key and fills in what comes before each. Throws Error for more than 2^32 - 1 vertices or triangles.
void number_surface(std::vector<SurfaceElements>& blocks);
Mesh extract_surface_part(graph::Runner& runner, const VoxelMap& map, const SurfacePart& part,
                          std::span<const SurfaceElements> numbered);

}  // namespace patina
