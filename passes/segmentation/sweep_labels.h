#pragma once

#include "engine/graph/frame.h"
#include "passes/model/label_map.h"
#include "passes/model/segment_table.h"
#include "passes/model/voxel_map.h"

namespace patina {

/// Goes through one of gpu::kSweepParts parts of the map, chosen by the blocks' keys and the frame's stamp over
/// gpu::kSweepEvery: replaces
/// labels by their roots, those given up by 0, and counts the voxels of each (gpu::SegmentLabel::tally). `params` holds
/// gpu::SegmentationParams.
void add_sweep_labels(graph::Frame& frame, const VoxelMap& map, const VoxelMapIds& ids, LabelMapIds& labels,
                      SegmentTableIds& table, graph::BufferId params);

}  // namespace patina
