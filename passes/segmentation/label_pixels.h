#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/segmentation/frame_segments.h"

namespace patina {

/// The label of each pixel: the root (`parents`) of what the map said there (`map_label`, add_sample_labels of every
/// gpu::kSampleStride-th pixel), where it knew one and the sampled pixel is of the same segment, or this one of none;
/// else its segment's (`segment_labels`, u32 per segment). Returns r32ui of `extent`, 0 where neither knows. Throws
/// Error when map_label or the segments are not of that extent.
graph::ImageId add_label_pixels(graph::FrameGraph& frame, const FrameSegments& segments, graph::ImageId map_label,
                                graph::BufferId parents, graph::BufferId segment_labels, Extent2D extent);

}  // namespace patina
