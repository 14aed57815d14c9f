#pragma once

#include "engine/graph/frame.h"
#include "passes/model/segment_table.h"
#include "passes/model/voxel_map.h"
#include "passes/segmentation/claim_voxels.h"
#include "passes/segmentation/frame_segments.h"

namespace patina {

struct UpdatedLabels {
    graph::BufferId words;  ///< LabelMap, without tags
    graph::ImageId label;   ///< W x H r32ui: what the map said of the pixel, else what its segment got; 0: neither
};

/// Carries the labels of a frame's segments (`segment_labels`, u32 per segment) over to the voxels that its pixels speak
/// for (claim_voxels.h): agreement raises a voxel's confidence, contradiction lowers it and at last replaces its label.
/// Counts voxels and flips in gpu::SegmentCounters. Throws Error when images differ in extent.
UpdatedLabels add_update_labels(graph::Frame& frame, const VoxelMap& map, const ClaimedVoxels& claimed,
                                SegmentTableIds& table, const FrameSegments& segments, graph::BufferId segment_labels);

}  // namespace patina
