#pragma once

#include "engine/graph/frame.h"
#include "passes/fusion/visible_blocks.h"
#include "passes/model/map_access.h"
#include "passes/model/voxel_map.h"

namespace patina {

/// The map's labels where a camera sees its surface.
struct SampledLabels {
    graph::ImageId label;       ///< W x H r32ui: root of the label of the voxel that holds the surface point; 0: none
    graph::BufferId blocks;     ///< u32: count, then the ids of the blocks that hold surface points, in no order
    graph::BufferId arguments;  ///< dispatch of one group per listed block, in rows of gpu::kGroupsPerRow
};

/// Looks up `labels` (LabelMap) at each point of `position_m` (W x H rgba32f, world; w is 0 where nothing was hit), and
/// takes their roots in `parents` (SegmentTable).
SampledLabels add_sample_labels(graph::Frame& frame, const VoxelMap& map, graph::BufferId labels,
                                graph::BufferId parents, const VisibleBlocks& visible, graph::ImageId position_m,
                                MapAccess access);

}  // namespace patina
