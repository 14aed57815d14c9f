#pragma once

#include "engine/graph/frame_graph.h"
#include "shared/segmentation/frame_segments.h"

namespace patina {

/// Extent of every stride-th pixel in x and y.
inline Extent2D sampled_extent(Extent2D full, uint32_t stride) {
    return {(full.width + stride - 1) / stride, (full.height + stride - 1) / stride};
}

/// The parts that one frame falls into.
struct FrameSegments {
    graph::ImageId segment;    ///< r32ui, of every stride-th pixel: which segment it belongs to; 0: unknown
    graph::BufferId segments;  ///< gpu::FrameSegment[capacity + 1]; element 0 stands for no segment and is empty
    graph::BufferId count;     ///< gpu::FrameSegmentCount
    uint32_t stride = 1;       ///< in x and y
};

}  // namespace patina
