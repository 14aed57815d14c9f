#pragma once

#include "engine/graph/runner.h"
#include "passes/state/voxel_map.h"
#include "patina/scene.h"
#include "reconstruction/streaming/streaming.h"

namespace patina {

/// The surface of a map that the device does not hold at once; byte by byte the mesh that extract_surface() returns of
/// one that it does. Brings the map back cube by cube, twice: to count what each holds, and to write it to its place.
/// Waits. Throws Error where the pool of voxel blocks cannot hold the smallest cube with what is beside it.
Mesh extract_surface_in_parts(graph::Runner& runner, const VoxelMap& map, Streaming& streaming);

}  // namespace patina
