#pragma once

#include "passes/segmentation/claim_edges.h"
#include "passes/segmentation/find_edges.h"
#include "passes/segmentation/frame_segments.h"

namespace patina {

struct SegmentSettings {
    EdgeSettings edges{};
    FoldSettings folds{};
    uint32_t min_pixels = 60;  ///< smaller components are dropped
    uint32_t capacity = gpu::kMaxFrameSegments;
    uint32_t stride_px = 1;  ///< between pixels that are looked at, in x and y
};

/// Divides a frame into the smooth, convex parts of its surface that have one colour: edges, connected components of
/// what lies between them, edge pixels given back to the neighbour whose tangent plane they lie on, and parts joined
/// across creases within a strong colour. Looks at every stride_px-th pixel in x and y; gpu::FrameSegment::pixels
/// counts all that these stand for. `model_position_m`, `reading_m` and `color` as for add_choose_depth, `camera` the
/// one that sees the first two. Throws Error for settings out of range, or when extents differ.
FrameSegments add_segment_frame(graph::FrameGraph& frame, graph::ImageId model_position_m, graph::ImageId reading_m,
                                const gpu::Camera& camera, const ColorPicture& color,
                                const SegmentSettings& settings = {});

/// Makes a segment of all pixels with the same given id, connected or not: `given` is W x H r32ui, 0: unknown, at most
/// 65535; larger ids count as unknown, as do pixels where `depth_m`, W x H r32f, is 0. gpu::FrameSegment::key holds the
/// id. Throws Error when extents differ.
FrameSegments add_given_segments(graph::FrameGraph& frame, graph::ImageId given, graph::ImageId depth_m,
                                 uint32_t capacity = gpu::kMaxFrameSegments);

}  // namespace patina
