#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/segmentation/frame_segments.h"
#include "passes/segmentation/segment_overlaps.h"
#include "passes/state/segment_table.h"

namespace patina {

/// What is known of the materials of labels.
struct KnownMaterials {
    graph::BufferId kd;    ///< gpu::SegmentKd per label
    graph::BufferId fits;  ///< gpu::WardFit by label; what is beyond its end is not known
};

/// Gives each segment a label. Where ids are given, that is its key. Else it inherits the label which it shares most
/// pixels with, when that is at least inherit_pixels and more than inherit_share of its own; a segment without one that
/// has at least new_pixels gets the next free label, in the order of segments; the others get none. Two labels that
/// segments share in merge_count frames more than they are seen apart are merged into the one that more was seen of, if
/// their materials agree: kd's chromaticity and luminance where both have records enough, else the chromaticity of
/// their colours; and the specular fits where both are sure. Every gpu::kSweepFrames frames labels which hold fewer
/// than prune_voxels, and were not seen for prune_frames, are given up, and those that no voxel holds any more are free
/// again. After Tateno, Tombari, Navab 2015, with the pair counts of Grinvald et al. 2019. `params` holds
/// gpu::SegmentationParams. Replaces
/// KnownMaterials::kd. Returns u32 per segment: its label; 0 where it has none.
graph::BufferId add_assign_labels(graph::FrameGraph& frame, SegmentTableIds& table, const FrameSegments& segments,
                                  const SegmentOverlaps& overlaps, KnownMaterials& materials, graph::BufferId params);

}  // namespace patina
