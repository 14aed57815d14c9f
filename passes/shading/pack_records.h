#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/observation_map.h"
#include "passes/state/reflectance_state.h"

namespace patina {

/// What interpolation between records reads of each, in one load. Returns a uvec4 per record of the map's capacity
/// (lib/records/packed_records.glsl); undefined for ids not in use.
graph::BufferId add_pack_records(graph::FrameGraph& frame, const ObservationMap& map, const ObservationMapIds& records,
                                 const ReflectanceStateIds& state);

}  // namespace patina
