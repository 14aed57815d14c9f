#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/segment_table.h"

namespace patina {

/// Where add_relabel_records() relabels records on the device: moves the sums of those of the same part that are away
/// (AwayAlbedo) to the labels' roots.
void add_relabel_away(graph::FrameGraph& frame, graph::BufferId& away, const SegmentTableIds& table,
                      graph::BufferId params);

}  // namespace patina
