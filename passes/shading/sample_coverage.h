#pragma once

#include "passes/shading/predict_radiance.h"

namespace patina {

/// The surface as one camera sees it, and where to look for its records.
struct SampleCoverageInputs {
    graph::ImageId position_m;  ///< W x H rgba32f: world; w is 0 where nothing was hit
    graph::BufferId view;       ///< gpu::ViewParams of the camera
    graph::BufferId view_grid;  ///< u32 per block of the box around the view: block id of the voxel map, or kNoBlock
    PackedRecords packed;       ///< of the same view
};

/// How well the surface is known that a camera sees. Returns W x H rgba16f: r: observations, 0 to
/// gpu::kMaxObservations; g: certainty of the diffuse albedo's least sure channel, 0 to 1; both the trilinear mean over
/// those of the eight voxels around the point that have a record, 0 where none has; a = 1, or all zero where nothing
/// was hit.
graph::ImageId add_sample_coverage(graph::FrameGraph& frame, const ObservationMap& map,
                                   const ObservationMapIds& records, const SampleCoverageInputs& inputs);

}  // namespace patina
