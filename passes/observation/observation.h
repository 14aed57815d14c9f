#pragma once

#include "passes/observation/allocate_records.h"

namespace patina {

/// The records that one frame concerned.
struct CollectedRecords {
    RecordList visible;  ///< whose voxel a visited pixel shows
    RecordList changed;  ///< of these, whose observations, surface or label changed
};

/// Collects a frame's observations: all passes, from the model as it was cast into the depth camera after the frame was
/// fused. Throws Error when images of the depth camera
/// differ in extent, or a setting is out of its range.
CollectedRecords add_collect_observations(graph::FrameGraph& frame, const ObservationMap& map, ObservationMapIds& ids,
                                          const ObservationInputs& inputs, const ObservationSettings& settings,
                                          const gpu::Camera& depth_camera, const gpu::Camera& color_camera,
                                          uint32_t frame_index);

}  // namespace patina
