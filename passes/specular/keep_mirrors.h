#pragma once

#include <cstdint>

#include "engine/graph/frame_graph.h"
#include "passes/state/ward_fits.h"

namespace patina {

/// Of what is known of segments, keeps which are mirrors for sure (gpu::SegmentMaterial::mirror from 0.9 on). The rest
/// is as if nobody had looked: no sums of add_fit_mirrors(), no gloss, and a version that tells so. Replaces
/// `fits.mirrors` and `segment_materials`, of which there are `materials`.
void add_keep_mirrors(graph::FrameGraph& frame, const WardFits& table, WardFitIds& fits, uint32_t materials,
                      graph::BufferId& segment_materials);

}  // namespace patina
