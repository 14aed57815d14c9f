#pragma once

#include <optional>

#include "engine/graph/frame_graph.h"
#include "passes/observation/observation_params.h"
#include "passes/state/observation_map.h"
#include "passes/state/record_list.h"

namespace patina {

/// What a frame's observations are made from; images of the depth camera but for the colour.
struct ObservationInputs {
    graph::ImageId position_m;               ///< the model as cast into the depth camera (add_raycast)
    graph::ImageId normal;                   ///< its normals
    graph::ImageId depth_m;                  ///< r32f, 0: no reading
    graph::ImageId slope;                    ///< of the readings (add_measure_slope)
    graph::ImageId color_linear;             ///< the colour camera's rgba16f (add_convert_color)
    std::optional<graph::ImageId> labels{};  ///< r32ui, what each pixel belongs to; 0: unknown
    std::optional<CameraMotion> motion{};    ///< empty: the picture is sharp
};

/// Lists the voxels whose surface the frame's pixels show, each once, taking records for those that have none, as far
/// as the pools reach: touch (insert the keys of blocks), select and assign as for the voxel map; then the same for
/// voxels. Every params.stride_px-th pixel looks, so that the work is bounded by pixels, whatever the voxels' size;
/// its phase changes from frame to frame. `params` holds gpu::ObservationParams, `values` the same.
RecordList add_allocate_records(graph::FrameGraph& frame, const ObservationMap& map, ObservationMapIds& ids,
                                const ObservationInputs& inputs, graph::BufferId params,
                                const gpu::ObservationParams& values);

}  // namespace patina
