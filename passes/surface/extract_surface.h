#pragma once
#include "engine/graph/runner.h"
#include "passes/model/voxel_map.h"
#include "passes/surface/mesh.h"
namespace patina {
inline Mesh extract_surface(graph::Runner&, const VoxelMap&) { return {}; }
}  // namespace patina
