#pragma once

#include <string>

#include "engine/graph/frame.h"

namespace patina {

/// How many words of 32 pixels of a row a picture has.
inline uint32_t words_of(Extent2D extent) { return (extent.width + 31) / 32 * extent.height; }

/// A buffer of zeros, a u32 for each key, as add_number_segments takes it.
graph::BufferId add_empty_keys(graph::Frame& frame, const std::string& name, uint32_t keys);

/// Components in the order of their keys.
struct NumberedSegments {
    graph::BufferId numbers;   ///< u32 per key, 0: dropped; defined where the key has enough pixels
    graph::BufferId segments;  ///< gpu::FrameSegment[capacity + 1], of which only the key is known
    graph::BufferId count;     ///< gpu::FrameSegmentCount
};

/// Numbers the keys that have at least `min_pixels` from 1 on; those after the first `capacity` are dropped and
/// counted. `pixels`: u32 per key, from add_empty_keys. Throws Error for min_pixels or capacity of 0, or a capacity
/// above gpu::kMaxFrameSegments.
NumberedSegments add_number_segments(graph::Frame& frame, graph::BufferId pixels, uint32_t min_pixels,
                                     uint32_t capacity);

}  // namespace patina
