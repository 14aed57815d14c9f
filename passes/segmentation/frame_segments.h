#pragma once

#include "engine/graph/frame.h"
#include "shared/frame_segments.h"

namespace patina {

/// The parts that one frame falls into.
struct FrameSegments {
    graph::ImageId segment;    ///< W x H r32ui: which segment a pixel belongs to; 0: unknown
    graph::BufferId segments;  ///< gpu::FrameSegment[capacity + 1]; element 0 stands for no segment and is empty
    graph::BufferId count;     ///< gpu::FrameSegmentCount
};

}  // namespace patina
