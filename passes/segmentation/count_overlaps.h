#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/segmentation/frame_segments.h"
#include "passes/segmentation/segment_overlaps.h"
#include "passes/state/segment_table.h"

namespace patina {

/// Slots of the overlap table for pictures of this extent: a segment of which a label covers less than some pixels
/// does not matter.
uint32_t overlap_slots(Extent2D extent);

/// Counts the pixels of `segments` by label in `map_label` (add_sample_labels of every gpu::kSampleStride-th pixel;
/// each stands for those around it), and adds chromaticities of `color_linear` (rgba16f, seen by
/// gpu::SegmentationParams::color_camera) where clipping did not change them to the labels' sums. `params` holds
/// gpu::SegmentationParams. Throws Error when images do not fit each other.
SegmentOverlaps add_count_overlaps(graph::FrameGraph& frame, SegmentTableIds& table, const FrameSegments& segments,
                                   graph::ImageId map_label, graph::ImageId position_m, graph::ImageId color_linear,
                                   graph::BufferId params);

}  // namespace patina
