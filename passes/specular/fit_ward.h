#pragma once

#include <optional>

#include <glm/glm.hpp>

#include "engine/graph/frame_graph.h"
#include "passes/state/observation_map.h"
#include "passes/state/segment_batch.h"
#include "passes/state/segment_samples.h"
#include "passes/state/specular_estimates.h"
#include "passes/state/ward_fits.h"

namespace patina {

/// What a fit reads.
struct FitWardInputs {
    const ObservationMap& map;
    const ObservationMapIds& records;  ///< with the visibility of the lights
    graph::BufferId status;            ///< ReflectanceStateIds::status
    graph::BufferId lights;            ///< Lights::upload
    uint32_t position_version = 0;     ///< of the lights
    const SegmentSamples& samples;
    const SegmentSampleIds& sample_ids;
    graph::BufferId network;  ///< SpecularEstimateIds::materials: alpha's prior, where there is an estimate
    uint32_t materials = 0;   ///< entries of the table of materials
    float memory = 0.93f;     ///< what is left of the frames before when a segment is fitted again
};

/// Fits Ward's ks and alpha (paper, Eq. 2-6) of a batch's segments to the observations of the voxels that they keep.
/// Given alpha, the model is linear in kd, per voxel, and in ks: kd drops out with the mean over a voxel's
/// observations, and ks follows in closed form for each alpha of a grid (variable projection). The result is the mean
/// over these by how likely they are, or, where one step of the grid holds all that is likely, the best between its
/// steps. Flat views and voxels whose lights are not known, or all hidden, are left out; outliers of the estimate
/// before count less. A clipped channel counts, for each alpha, where what the fit before found for it is darker. Where
/// the normals of records beside a voxel's show that the surface bends, its highlights are taken for blurred: alpha^2 +
/// blur^2 in place of alpha^2 (Toksvig 2005). Sums are kept by label, `memory` of them from one fit to the next. Where
/// observations do not tell, priors hold: ks 0.04, and the network's alpha, else 0.2. With the result follows the kd of
/// the whole segment, by least squares over its voxels' colours without their highlights. `fits` is brought up to date,
/// and `segment_materials` (gpu::SegmentMaterial by label), whose version changes when the material does.
void add_fit_ward(graph::FrameGraph& frame, const FitWardInputs& inputs, const SegmentBatch& batch,
                  const WardFits& table, WardFitIds& fits, graph::BufferId& segment_materials);

/// The kd of a whole segment as the fit or the network has it, before refinement; empty where neither knows it.
std::optional<glm::vec3> kd_of(const gpu::WardFit& fit);

}  // namespace patina
