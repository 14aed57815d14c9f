#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "engine/graph/runner.h"
#include "passes/state/voxel_map.h"
#include "passes/surface/extract_surface.h"
#include "patina/scene.h"
#include "reconstruction/streaming/streaming.h"

namespace patina {

/// The surface of a map in cells, each a mesh of its own; the device need not hold the map at once. Vertices at a
/// border belong to the meshes on both sides of it, with the same bytes. What cells hold depends on the map's content
/// alone. Both must outlive this, and stay as they are.
class SurfaceCells {
  public:
    /// Cells of `edge_m`, counted from the map's lowest corner; empty: one of all. Looks at the whole map once, to
    /// count; waits. Throws Error where the pool of voxel blocks cannot hold the smallest cube that a cell is divided
    /// into, or as extract_surface() does.
    SurfaceCells(graph::Runner& runner, const VoxelMap& map, Streaming& streaming, std::optional<double> edge_m);

    /// How many there are, in a fixed order; without blocks none.
    size_t size() const { return cells_.size(); }

    /// The mesh of one; waits. One cell of all has the bytes of extract_surface(). Throws Error as the constructor.
    Mesh extract(size_t cell);

  private:
    void choose_cubes(const std::vector<glm::ivec3>& blocks, uint64_t most_blocks);
    void count(const std::vector<glm::ivec3>& blocks);
    std::vector<SurfacePart> cubes_of(const std::vector<glm::ivec3>& blocks) const;
    void bring(const SurfacePart& cube);

    graph::Runner& runner_;
    const VoxelMap& map_;
    Streaming& streaming_;
    bool any_away_ = false;
    glm::ivec3 low_{0};              ///< lowest coordinates of blocks
    int cell_ = 1, cube_ = 1;        ///< their edges, in blocks
    std::vector<glm::ivec3> cells_;  ///< their coordinates, in units of cells
    std::vector<SurfaceElements> elements_;
};

}  // namespace patina
