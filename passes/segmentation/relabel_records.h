#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/observation_map.h"
#include "passes/state/segment_table.h"

namespace patina {

/// Goes through one of gpu::kSweepParts parts of the observations, chosen by the blocks' keys and the frame's stamp
/// over gpu::kSweepEvery:
/// replaces the labels of records by their roots, those given up by 0. `params` holds gpu::SegmentationParams.
void add_relabel_records(graph::FrameGraph& frame, const ObservationMap& map, ObservationMapIds& records,
                         const SegmentTableIds& table, graph::BufferId params);

}  // namespace patina
