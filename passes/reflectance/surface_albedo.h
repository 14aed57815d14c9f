#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/observation_map.h"
#include "passes/state/reflectance_state.h"

namespace patina {

/// The albedo of the surface around each record, as far as it looks the same: what records of a cell reflect diffusely,
/// over what they receive. Gathered light errs from record to record, and so does kd; how bright a surface looks does
/// not. So of records near each other (gpu::kSurfaceCellM) that face the same way and reflect about the same colour
/// (gpu::kSurfaceBrightness, kSurfaceTint) albedos are taken together; print and borders of shadows stay apart, since
/// they look different. That is a bilateral grid (Chen, Paris and Durand 2007) in world space, whose guide is the
/// reflected colour. Their mean is drawn to that of all records of the segment with the same tint, as far as light errs
/// alike all around. Replaces RecordSurroundings::around of the records in `cube_m` (centre in the world, half edge),
/// and looks at no others; 0 where a record's own light or colour is not known well, or everywhere, where more than
/// gpu::kMostSurfaceCells cells are in use.
void add_surface_albedo(graph::FrameGraph& frame, const ObservationMap& map, const ObservationMapIds& records,
                        ReflectanceStateIds& state, graph::BufferId lights, const glm::vec4& cube_m);

}  // namespace patina
