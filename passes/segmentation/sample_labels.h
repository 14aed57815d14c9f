#pragma once

#include "engine/graph/frame.h"
#include "passes/fusion/raycast.h"
#include "passes/fusion/visible_blocks.h"
#include "passes/model/voxel_map.h"

namespace patina {

/// Looks up `labels` (LabelMap) at the surface that a camera sees, and takes their roots in `parents` (SegmentTable).
/// Where the voxel that holds the surface point has no label, those half a voxel before and behind it are asked. Returns
/// W x H r32ui, 0 where there is none. Throws Error when the images of `model` differ in extent.
graph::ImageId add_sample_labels(graph::Frame& frame, const VoxelMap& map, graph::BufferId labels,
                                 graph::BufferId parents, const VisibleBlocks& visible, const RaycastImages& model);

}  // namespace patina
