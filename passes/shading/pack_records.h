#pragma once

#include "engine/graph/frame.h"
#include "passes/model/observation_map.h"
#include "passes/model/reflectance_state.h"

namespace patina {

/// What interpolation between records reads of each, in one load. Returns a uvec4 per record of the map's capacity
/// (lib/packed_records.glsl); undefined for ids not in use.
graph::BufferId add_pack_records(graph::Frame& frame, const ObservationMap& map, const ObservationMapIds& records,
                                 const ReflectanceStateIds& state);

}  // namespace patina
