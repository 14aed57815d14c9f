#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/observation_map.h"
#include "passes/state/segment_batch.h"
#include "passes/state/segment_samples.h"
#include "passes/state/ward_fits.h"
#include "shared/specular/mirror_fit.h"

namespace patina {

/// What the search for mirrors reads.
struct FitMirrorsInputs {
    const ObservationMap& map;
    const ObservationMapIds& records;
    graph::BufferId surroundings;  ///< ReflectanceStateIds::surroundings
    const SegmentSampleIds& sample_ids;
    uint32_t materials = 0;  ///< entries of the table of materials
    uint32_t stamp = 0;      ///< the frame's index + 1
    float memory = 0;        ///< what is left of the frames before when a segment is looked at again
};

/// Looks which segments of a batch reflect what is around them: metals and mirrors. Of each voxel that a segment keeps,
/// two views that lie far apart are compared with what the mirrored rays meet in the surroundings: the difference takes
/// away what is the voxel's own, whatever its albedo and its light. Regressing one on the other gives ks; the error of
/// single rays, which would make it too small, drops out with two independent sets of them (errors in variables). ks
/// less two standard deviations, where it is above what any dielectric reflects, makes gpu::SegmentMaterial::mirror;
/// 0.25 and more is a metal, 1. Sums are kept by label, `memory` of them from one look to the next. The version of
/// `segment_materials` changes with the result.
void add_fit_mirrors(graph::FrameGraph& frame, const FitMirrorsInputs& inputs, const SegmentBatch& batch,
                     const WardFits& table, WardFitIds& fits, graph::BufferId& segment_materials);

}  // namespace patina
