#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/record_list.h"
#include "passes/state/segment_batch.h"
#include "passes/state/specular_estimates.h"
#include "passes/state/ward_fits.h"

namespace patina {

/// What estimates of specular materials bring up to date.
struct SpecularMaterialIds {
    SpecularEstimateIds estimates;
    WardFitIds fits;
    graph::BufferId materials;  ///< gpu::SegmentMaterial by label
};

struct ChooseSegmentsInputs {
    graph::BufferId records;   ///< ObservationMapIds::records
    RecordList changed;        ///< in this frame
    graph::BufferId labels;    ///< SegmentTableIds::labels
    graph::BufferId counts;    ///< SegmentSampleIds::counts
    uint32_t label_count = 0;  ///< of all tables by label
    uint32_t materials = 0;    ///< entries of the table of materials
    uint32_t stamp = 0;        ///< the frame's index + 1
};

/// What a frame estimates.
struct ChosenSegments {
    SegmentBatch all;
    SegmentBatch doubtful;  ///< of these, those that the Ward fit was not sure of so far (gpu::kAskedBelowConfidence)
};

/// The segments that a frame estimates, at most `capacity`: by turns the one of which most observations changed since
/// it was estimated last, and the one that has waited longest, so that none starves. Only segments that keep samples
/// and changed at all are taken. What is known of labels that were handed out anew since is forgotten.
ChosenSegments add_choose_segments(graph::FrameGraph& frame, const ChooseSegmentsInputs& inputs, uint32_t capacity,
                                   SpecularMaterialIds& ids);

/// The network's estimates of a batch's segments become their materials as they are.
void add_adopt_estimates(graph::FrameGraph& frame, const SegmentBatch& batch, uint32_t materials,
                         SpecularMaterialIds& ids);

}  // namespace patina
