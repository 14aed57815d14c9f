#pragma once

#include "engine/graph/frame.h"
#include "passes/model/label_map.h"
#include "passes/model/map_access.h"
#include "passes/segmentation/surface_view.h"

namespace patina {

/// Extent of every stride-th pixel in x and y.
inline Extent2D sampled_extent(Extent2D full, uint32_t stride) {
    return {(full.width + stride - 1) / stride, (full.height + stride - 1) / stride};
}

/// Throws Error, naming the pass, unless labels were sampled at every gpu::kSampleStride-th pixel of the segments.
void check_sampled(const char* pass, Extent2D segments, Extent2D sampled);

/// Looks up the labels of the surface that a camera sees, and takes their roots in `parents` (SegmentTable). Where the
/// voxel that holds the surface point has none, those behind and before it are asked. Looks at every `stride`-th pixel
/// in x and y. Returns W / stride x H / stride, rounded up, r32ui, 0 where there is none. Throws Error when the images
/// of `surface` differ in extent.
graph::ImageId add_sample_labels(graph::Frame& frame, const VoxelMap& map, const LabelMapIds& labels,
                                 graph::BufferId parents, const SurfaceView& surface, MapAccess access,
                                 uint32_t stride = 1);

}  // namespace patina
