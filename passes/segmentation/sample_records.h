#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/observation_map.h"
#include "passes/state/segment_samples.h"

namespace patina {

/// Which records of segments may be kept.
struct SampleChoice {
    gpu::VoxelGrid voxels{};        ///< the voxel map's
    gpu::StreamRegion region{};     ///< where their blocks lie
    uint32_t min_observations = 0;  ///< records with fewer are kept only where there is room
    uint32_t seed = 1;
};

/// Chooses anew which records of each segment are kept, and sums up their albedo.
void add_sample_records(graph::FrameGraph& frame, const ObservationMap& map, const ObservationMapIds& records,
                        const SegmentSamples& samples, SegmentSampleIds& ids, const SampleChoice& choice);

/// Where the records lie that segments keep, for when these may leave the device and come back as others: uvec2 of a
/// block's key, gpu::kEmptyKey for none, and the voxel within it, gpu::kSegmentSamples per label.
graph::BufferId add_place_samples(graph::FrameGraph& frame, const ObservationMapIds& records,
                                  const SegmentSamples& samples, const SegmentSampleIds& ids);

/// Segments keep the records at these places again, as far as they are on the device.
void add_find_samples(graph::FrameGraph& frame, const ObservationMap& map, const ObservationMapIds& records,
                      const SegmentSamples& samples, SegmentSampleIds& ids, graph::BufferId places);

/// Draws `draws` different records of each segment at random, from those it keeps (paper, Section 3.6: 25). Returns u32
/// record ids, `draws` per label; gpu::kNoRecord for segments that keep fewer. The same seed draws the same voxels.
/// Throws Error when `draws` is 0 or above gpu::kSegmentSamples / 2, which large segments are sure to keep.
graph::BufferId add_draw_records(graph::FrameGraph& frame, const ObservationMapIds& records,
                                 const SegmentSamples& samples, const SegmentSampleIds& ids, uint32_t draws,
                                 uint32_t seed);

}  // namespace patina
