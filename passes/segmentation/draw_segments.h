#pragma once

#include "passes/segmentation/find_edges.h"
#include "passes/segmentation/label_components.h"
#include "passes/segmentation/number_segments.h"

namespace patina {

/// Writes every component's number into its pixels. Returns W x H r32ui, 0: none. `min_pixels` as for
/// add_number_segments.
graph::ImageId add_draw_segments(graph::Frame& frame, const Components& components, graph::BufferId numbers,
                                 uint32_t min_pixels);

/// Gives pixels that have depth but no segment to one within `reach_px` in x or y: the one on whose tangent plane they
/// lie, as near as settings.step_* say. Returns W x H r32ui.
graph::ImageId add_claim_edges(graph::Frame& frame, graph::ImageId segment, graph::ImageId surface,
                               const gpu::Camera& camera, const EdgeSettings& settings, uint32_t reach_px);

/// Adds up all of gpu::FrameSegment but its key, for the segments of a picture. Returns the table's next version.
graph::BufferId add_measure_segments(graph::Frame& frame, graph::BufferId segments, graph::ImageId segment,
                                     graph::ImageId surface, const gpu::Camera& camera);

}  // namespace patina
