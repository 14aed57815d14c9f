#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/segment_batch.h"
#include "passes/state/specular_estimates.h"

namespace patina {

/// Joins a batch's estimates with those of the frames before, as a TSDF is updated (paper, Section 3.6): per label
/// mean' = (W mean + w estimate) / (W + w) and W' = min(W + w, gpu::kMostEstimateWeight), in perceptual parameters, and
/// the material that the mean stands for. `estimates`: gpu::PerceptualMaterial per segment of the batch, as
/// add_run_network returns it for a network of 7 outputs; `drawn`: as add_hemi_images returns it. Segments of which no
/// voxel was drawn, estimates that are not finite, and labels beyond the table change nothing. Throws Error when
/// `weight` is not above 0.
void add_fuse_estimates(graph::FrameGraph& frame, const SegmentBatch& batch, graph::BufferId estimates,
                        graph::BufferId drawn, const SpecularEstimates& table, SpecularEstimateIds& ids,
                        float weight = 1);

}  // namespace patina
