#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/label_map.h"
#include "passes/state/observation_map.h"
#include "passes/state/segment_samples.h"
#include "passes/state/segment_table.h"
#include "passes/state/voxel_map.h"

namespace patina {

/// When a label's colours are two.
struct SplitChoice {
    float least_apart = 0;  ///< of the means of their chromaticities, r and g over r + g + b
    uint32_t stamp = 1;     ///< the frame's index + 1
};

/// Splits labels whose surface has two colours, as where a dish was taken for a part of the board that it lies on: no
/// edge of shape parts them, and that of colour had gaps. Of the records that a label keeps (sample_records.h) the
/// chromaticities along their principal axis are parted half-way between the means of Otsu's two parts (1979). If both
/// are narrow, far from each other and lie apart in space, the smaller becomes a label of its own, the first one's
/// partner. Prints are no such thing: their colours lie among each other. In every call voxels of labels with a partner
/// go to the one whose colour is theirs, and records to that of the voxel at their surface; between calls
/// update_labels.h takes a vote for either as one for what they have. A label has one partner at most. What is known of
/// the gloss of both begins anew, and their kd when samples are chosen. `samples` holds records that are still where
/// they were. What is not on the device is parted in a later call. Replaces `labels`, `records`, `table` and
/// SegmentSampleIds::kd. Nothing is split while no labels are free (gpu::SegmentCounters::refused).
void add_split_labels(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& voxels, LabelMapIds& labels,
                      const ObservationMap& observations, ObservationMapIds& records, SegmentTableIds& table,
                      SegmentSampleIds& samples, uint32_t capacity_labels, const SplitChoice& choice);

}  // namespace patina
