#pragma once

#include <optional>

#include <glm/glm.hpp>

#include "engine/graph/frame_graph.h"
#include "passes/state/observation_map.h"
#include "shared/reflectance/reflectance.h"

namespace patina {

/// The mean albedo of each segment over its records, each weighted by its certainty: what a surface point has that no
/// record knows. Returns gpu::SegmentAlbedo[labels], zero where a segment has no records; kd above 1 counts as 1.
/// Counts of records and observations include those that know nothing. `away`: AwayAlbedo, where records are away from
/// the device.
graph::BufferId add_average_segments(graph::FrameGraph& frame, const ObservationMap& map,
                                     const ObservationMapIds& records, uint32_t labels,
                                     std::optional<graph::BufferId> away = {});

/// A segment's kd from its sums; empty where too few records know it.
std::optional<glm::vec3> kd_of(const gpu::SegmentAlbedo& segment);

}  // namespace patina
