#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/ward_fits.h"
#include "shared/specular/material_bounds.h"

namespace patina {

/// What intervals follow from.
struct BoundMaterialsInputs {
    const WardFits& table;
    const WardFitIds& fits;
    graph::BufferId albedo;  ///< gpu::SegmentAlbedo by label, add_average_segments()
};

/// Where kd, ks and alpha of each segment lie with a probability of 50, 80, 90 and 95 %, from the sums that the Ward
/// fit keeps. docs/develop/specular.md has the method: the likelihood of the 40 alphas, tempered, each with the ks that
/// it would have and with one that nobody saw; kd with the errors of light, surface and ks. Intervals hold the
/// estimate. Returns gpu::MaterialBounds[gpu::kBoundsLevels] per label of the table: of a label without a fit those of
/// the prior, of one without records undefined. Changes nothing of the fits.
graph::BufferId add_bound_materials(graph::FrameGraph& frame, const BoundMaterialsInputs& inputs);

}  // namespace patina
