#pragma once

#include "engine/graph/frame.h"
#include "passes/fusion/raycast.h"
#include "passes/fusion/visible_blocks.h"
#include "passes/model/segment_table.h"
#include "passes/model/voxel_map.h"
#include "passes/segmentation/frame_segments.h"
#include "passes/segmentation/list_surface.h"

namespace patina {

/// Carries the labels of a frame's segments (`segment_labels`, u32 per segment) over to the voxels of `blocks` within a
/// voxel of the surface that the frame sees: agreement raises a voxel's confidence, contradiction lowers it and at last
/// replaces its label. `model` is the surface as the frame's camera sees it. Counts voxels and flips in
/// gpu::SegmentCounters. Throws Error when images differ in extent.
void add_update_labels(graph::Frame& frame, const VoxelMap& map, const VoxelMapIds& ids, LabelMapIds& labels,
                       SegmentTableIds& table, const VisibleBlocks& visible, const SurfaceBlocks& blocks,
                       const RaycastImages& model, const FrameSegments& segments, graph::BufferId segment_labels);

}  // namespace patina
