#include "passes/observation/observation.h"

#include "passes/observation/update_records.h"

namespace patina {

CollectedRecords add_collect_observations(graph::FrameGraph& frame, const ObservationMap& map, ObservationMapIds& ids,
                                          const ObservationInputs& inputs, const ObservationSettings& settings,
                                          const gpu::Camera& depth_camera, const gpu::Camera& color_camera,
                                          uint32_t frame_index) {
    frame.common_extent({inputs.position_m, inputs.normal, inputs.depth_m, inputs.slope});
    if (inputs.labels) frame.common_extent({inputs.depth_m, *inputs.labels});
    const gpu::ObservationParams values =
        make_observation_params(map, settings, depth_camera, color_camera, frame_index, inputs.motion);
    const auto params = frame.upload<gpu::ObservationParams>("observation.params", std::span(&values, 1));
    const RecordList visible = add_allocate_records(frame, map, ids, inputs, params, values);
    const RecordList changed = add_update_records(frame, map, ids, inputs, visible, params, values);
    return {visible, changed};
}

}  // namespace patina
