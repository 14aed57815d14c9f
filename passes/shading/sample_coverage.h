#pragma once

#include "passes/fusion/visible_blocks.h"
#include "passes/shading/predict_radiance.h"

namespace patina {

/// How well the surface is known that a camera sees: `position_m` is W x H rgba32f as add_raycast makes it from
/// `visible`, `packed` the records of that view. Returns W x H rgba16f: r: observations, 0 to gpu::kMaxObservations;
/// g: certainty of the diffuse albedo's least sure channel, 0 to 1; both the trilinear mean over those of the eight
/// voxels around the point that have a record, 0 where none has; a = 1, or all zero where nothing was hit.
graph::ImageId add_sample_coverage(graph::FrameGraph& frame, const ObservationMap& map,
                                   const ObservationMapIds& records, const VisibleBlocks& visible,
                                   const PackedRecords& packed, graph::ImageId position_m);

}  // namespace patina
