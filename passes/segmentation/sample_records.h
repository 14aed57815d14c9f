#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/observation_map.h"
#include "passes/state/segment_samples.h"

namespace patina {

/// Chooses anew which records of each segment are kept, among those with at least `min_observations`, and
/// sums up their albedo.
void add_sample_records(graph::FrameGraph& frame, const ObservationMap& map, const ObservationMapIds& records,
                        const SegmentSamples& samples, SegmentSampleIds& ids, uint32_t min_observations, uint32_t seed);

/// Draws `draws` different records of each segment at random, from those it keeps (paper, Section 3.6: 25). Returns u32
/// record ids, `draws` per label; gpu::kNoRecord for segments that keep fewer. The same seed draws the same voxels.
/// Throws Error when `draws` is 0 or above gpu::kSegmentSamples / 2, which large segments are sure to keep.
graph::BufferId add_draw_records(graph::FrameGraph& frame, const ObservationMapIds& records,
                                 const SegmentSamples& samples, const SegmentSampleIds& ids, uint32_t draws,
                                 uint32_t seed);

}  // namespace patina
