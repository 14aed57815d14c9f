#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/network.h"
#include "passes/state/observation_map.h"
#include "passes/state/segment_batch.h"
#include "passes/state/segment_samples.h"

namespace patina {

/// What the segments of a batch look like.
struct HemiImages {
    graph::BufferId images;  ///< vec4[segment][kHemiSamples][kHemiSide][kHemiSide]: linear RGB, 0
    graph::BufferId drawn;  ///< u32[segment][kHemiSamples]: record ids; all gpu::kNoRecord where there was none to draw
};

/// HemiImages of the segments of a batch (paper, Section 3.6; Kim et al. 2017): of each segment gpu::kHemiSamples of
/// the records that it keeps are drawn at random, among those with at least gpu::kLeastHemiObservations; different ones
/// where there are so many, else some several times. The directions of a record's observations are turned so that z is
/// its normal and mapped to a disk that just fills the image; each pixel has the colour of the nearest observation. The
/// same seed draws the same voxels. Images of a segment without such a record are 0; undefined beyond the batch's
/// segments.
HemiImages add_hemi_images(graph::FrameGraph& frame, const ObservationMap& map, const ObservationMapIds& records,
                           const SegmentSamples& samples, const SegmentSampleIds& sample_ids, const SegmentBatch& batch,
                           HemisphereMap hemisphere_map, uint32_t seed);

}  // namespace patina
