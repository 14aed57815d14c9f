#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/segment_table.h"

namespace patina {

/// Makes use of a larger segment table, in the frame in which its enlargement from `before` labels was committed: the
/// new labels become free, behind those that were so before. Labels in use keep their numbers.
void add_grow_labels(graph::FrameGraph& frame, const SegmentTable& table, SegmentTableIds& ids, uint32_t before);

}  // namespace patina
