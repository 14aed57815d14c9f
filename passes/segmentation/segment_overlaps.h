#pragma once

#include "engine/graph/frame_graph.h"

namespace patina {

/// What each segment of a frame shares with each label of the map.
struct SegmentOverlaps {
    graph::BufferId table;  ///< gpu::SegmentOverlap[gpu::SegmentationParams::overlap_slots], a hash table
    graph::BufferId list;   ///< u32: entries, then their slots in no order; three quarters of the slots: overflow
};

}  // namespace patina
