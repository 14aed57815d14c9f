#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/observation_map.h"

namespace patina {

/// Makes use of an observation map's larger pool of blocks, in the frame in which its enlargement from `before` was
/// committed: as add_grow_voxels does for the voxel map's.
void add_grow_observed_blocks(graph::FrameGraph& frame, const ObservationMap& map, ObservationMapIds& ids,
                              uint32_t before);

/// The same for its records, of which there were `before`. Voxels that the full pool refused may ask again.
void add_grow_records(graph::FrameGraph& frame, const ObservationMap& map, ObservationMapIds& ids, uint32_t before);

}  // namespace patina
