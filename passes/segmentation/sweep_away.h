#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/segment_table.h"

namespace patina {

/// In the frame of a sweep (add_sweep_labels): counts the voxels of the part that has its turn that are away from the
/// device. `away` holds their number by label, as they left or were relabelled last.
void add_sweep_away(graph::FrameGraph& frame, SegmentTableIds& table, graph::BufferId away);

}  // namespace patina
