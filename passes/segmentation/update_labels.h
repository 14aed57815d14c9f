#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/segmentation/due_blocks.h"
#include "passes/segmentation/frame_segments.h"
#include "passes/segmentation/surface_view.h"
#include "passes/state/label_map.h"
#include "passes/state/map_access.h"
#include "passes/state/segment_table.h"
#include "passes/state/voxel_map.h"

namespace patina {

/// Carries the labels of a frame's segments (`segment_labels`, u32 per segment) over to the voxels of `due` within a
/// voxel of the surface that the frame sees: agreement raises a voxel's confidence, contradiction lowers it and at last
/// replaces its label. A voxel without one takes that of a surface within two voxels, as beside silhouettes noise
/// leaves gaps. A block has settled (LabelMapIds::stamps) when all its voxels near the surface have a confidence of
/// gpu::kSettledConfidence, and none was contradicted, and is restless while one of them has no label or was
/// contradicted; of one that has settled, a quarter of the voxels has its turn. Counts voxels and flips in
/// gpu::SegmentCounters. Throws Error when images do not fit each other, and when `access` is MapAccess::kTexel and the
/// map too large for it.
void add_update_labels(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& ids, LabelMapIds& labels,
                       SegmentTableIds& table, const SurfaceView& surface, const DueBlocks& due,
                       const FrameSegments& segments, graph::BufferId segment_labels, MapAccess access);

}  // namespace patina
