#pragma once

#include <cstdint>

#include "engine/graph/frame_graph.h"
#include "passes/state/observation_map.h"
#include "shared/shading/sample_reflectance.h"

namespace patina {

/// Points of the surface, and what to find out about them from.
struct SampleReflectanceInputs {
    graph::BufferId positions_m;  ///< float[3 * points]: world
    graph::BufferId normals;      ///< float[3 * points]: world, unit length; 0 where it is not known
    graph::BufferId packed;       ///< uvec4 per record (add_pack_records)
    graph::BufferId segments;     ///< gpu::SegmentAlbedo[material_count] (add_average_segments)
    graph::BufferId gathered;     ///< gpu::RecordSurroundings per record
    uint32_t points = 0;          ///< above 0
    uint32_t material_count = 0;
};

/// The diffuse albedo and the segment of each point by the rules of add_predict_radiance, for points that no camera
/// need see, such as a mesh's vertices. Returns gpu::SampledReflectance[points]. A point without a normal is known to
/// no record.
graph::BufferId add_sample_reflectance(graph::FrameGraph& frame, const ObservationMap& map,
                                       const ObservationMapIds& records, const SampleReflectanceInputs& inputs);

}  // namespace patina
