#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/label_map.h"
#include "passes/state/segment_table.h"
#include "passes/state/voxel_map.h"

namespace patina {

/// Goes through one of gpu::kSweepParts parts of the map, chosen by the blocks' keys and the frame's stamp over
/// gpu::kSweepEvery: replaces
/// labels by their roots, those given up by 0, and counts the voxels of each (gpu::SegmentLabel::tally). `params` holds
/// gpu::SegmentationParams.
void add_sweep_labels(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& ids, LabelMapIds& labels,
                      SegmentTableIds& table, graph::BufferId params);

}  // namespace patina
