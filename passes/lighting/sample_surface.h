#pragma once

#include <span>

#include <glm/glm.hpp>

#include "engine/graph/frame_graph.h"
#include "passes/state/observation_map.h"
#include "passes/state/voxel_map.h"
#include "shared/lighting/fit_lights.h"

namespace patina {

/// Draws voxels of the observed surface, at most one per place of a table that block keys and `seed` hash to, so that
/// what is drawn does not depend on the order of records: gpu::LightSample[2 * gpu::kLightSamples], first of all voxels
/// with enough observations, then of those of them with a highlight. Places without one have no observations. The
/// colour is the mean of the darkest observations. `status`: gpu::RecordStatus per record, which says what a record
/// gathered of the light around it.
graph::BufferId add_sample_surface(graph::FrameGraph& frame, const ObservationMap& map,
                                   const ObservationMapIds& records, graph::BufferId status, uint32_t seed);

/// What rays to trial lights are marched through.
struct TrialMap {
    const VoxelMap& map;
    const VoxelMapIds& voxels;
    graph::BufferId surroundings;  ///< ReflectanceStateIds; add_mark_blocks() has marked the blocks
};

/// What lamps of intensity 1 at these places (world, m; at most gpu::kTrialLights) give the first `count` samples, a
/// multiple of gpu::kTrialSamples: cos / (pi r^2), 0 where the model stands in the way. Space that was never seen is
/// open. Returns float[trial][gpu::kLightSamples].
graph::BufferId add_try_lights(graph::FrameGraph& frame, const TrialMap& model, graph::BufferId samples,
                               std::span<const glm::vec3> places_m, uint32_t count = gpu::kLightSamples);

/// Likewise the cosines to the directions of suns (unit length), 0 where they do not shine in: where the model stands
/// in the way, or no opening in which the surroundings show the sky lies on it. What lies outside `ball_m` (world,
/// radius) throws no shadow.
graph::BufferId add_try_suns(graph::FrameGraph& frame, const TrialMap& model, graph::BufferId samples,
                             std::span<const glm::vec3> directions, uint32_t count, glm::vec4 ball_m);

}  // namespace patina
