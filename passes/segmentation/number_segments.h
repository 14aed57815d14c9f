#pragma once

#include <string>

#include "engine/graph/frame_graph.h"
#include "passes/segmentation/frame_segments.h"

namespace patina {

/// How many words of 32 pixels a row, and a picture, has.
inline uint32_t row_words_of(Extent2D extent) { return (extent.width + 31) / 32; }
inline uint32_t words_of(Extent2D extent) { return row_words_of(extent) * extent.height; }

/// A buffer of zeros, a u32 for each key, as add_number_segments takes it.
graph::BufferId add_empty_keys(graph::FrameGraph& frame, const std::string& name, uint32_t keys);

/// Makes segments of components that are known by keys above 0. Those with at least `min_pixels` are numbered from 1 on
/// in the order of their keys; those after the first `capacity` are dropped and counted. `pixels`: u32 per key, begun
/// by add_empty_keys. `key`: W x H r32ui, 0 or too large: none. `depth_m`: W x H r32f, 0 where nothing is, which is in
/// no segment. Each pixel stands for `stride` times `stride` of those that `min_pixels` and gpu::FrameSegment::pixels
/// count. Throws Error when extents differ, for min_pixels or capacity of 0, or a capacity above
/// gpu::kMaxFrameSegments.
FrameSegments add_number_segments(graph::FrameGraph& frame, graph::BufferId pixels, graph::ImageId key,
                                  graph::ImageId depth_m, uint32_t min_pixels, uint32_t capacity, uint32_t stride = 1);

}  // namespace patina
