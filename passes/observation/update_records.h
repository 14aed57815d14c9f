#pragma once

#include "passes/observation/allocate_records.h"

namespace patina {

/// Adds to each listed voxel what the frame shows of it: its surface from the cast model (the mean plane over the
/// voxel's own size, then over frames), the colour at that point with the direction to the colour camera (at most
/// kMaxObservations, the most similar making room; paper, Section 3.4), a vote for its label. Readings that are
/// occluded, off the surface, far, grazing, near a depth edge, or without colour are left out; clipped channels are
/// marked. Returns the records whose observations, surface or label changed, which also carry the frame's stamp.
RecordList add_update_records(graph::FrameGraph& frame, const ObservationMap& map, ObservationMapIds& ids,
                              const ObservationInputs& inputs, const RecordList& visible, graph::BufferId params,
                              const gpu::ObservationParams& values);

}  // namespace patina
