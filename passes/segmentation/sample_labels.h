#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/segmentation/frame_segments.h"
#include "passes/segmentation/surface_view.h"
#include "passes/state/label_map.h"
#include "passes/state/map_access.h"

namespace patina {

/// Throws Error, naming the pass and `what` it got, unless that was sampled at every `stride`-th pixel of a picture.
void check_sampled(const char* pass, const char* what, Extent2D full, Extent2D sampled, uint32_t stride);

/// Looks up the labels of the surface that a camera sees, and takes their roots in `parents` (SegmentTable). Where the
/// voxel that holds the surface point has none, those behind and before it are asked. Looks at every `stride`-th pixel
/// in x and y. Returns W / stride x H / stride, rounded up, r32ui, 0 where there is none. Throws Error when the images
/// of `surface` differ in extent.
graph::ImageId add_sample_labels(graph::FrameGraph& frame, const VoxelMap& map, const LabelMapIds& labels,
                                 graph::BufferId parents, const SurfaceView& surface, MapAccess access,
                                 uint32_t stride = 1);

}  // namespace patina
