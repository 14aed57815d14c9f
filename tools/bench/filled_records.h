#pragma once

#include <array>
#include <vector>

#include <glm/glm.hpp>

#include "engine/graph/frame_graph.h"
#include "passes/state/observation_map.h"
#include "passes/state/record_list.h"
#include "passes/state/segment_samples.h"

namespace patina {

/// An observation of a record that is made up.
struct FilledObservation {
    glm::vec3 to_viewer{0, 0, 1};
    glm::vec3 rgb{0};
    std::array<bool, 3> clipped{};
};

/// A record that is made up: a surface within the voxel that a point lies in.
struct FilledRecord {
    glm::vec3 point_m{0};
    glm::vec3 normal{0, 0, 1};
    uint32_t label = 0;
    std::vector<FilledObservation> observations;  ///< at most gpu::kMaxObservations
};

/// Where a record is in the map: the key of its block, and the voxel's number within it.
struct FilledPlace {
    uint32_t block_key = 0;
    uint32_t voxel = 0;
};
FilledPlace place_of(const ObservationMap& map, const FilledRecord& record);

/// The surface point as the record keeps it: `point_m` moved within the tangent plane, below the voxel's centre.
glm::vec3 kept_point_m(const ObservationMap& map, const FilledRecord& record);

/// Writes records 0, 1, ... of a map that was just reset, without their entries in its table.
void add_fill_records(graph::FrameGraph& frame, const ObservationMap& map, ObservationMapIds& ids,
                      const std::vector<FilledRecord>& records);

/// What each segment keeps, by label: record ids, at most gpu::kSegmentSamples.
void add_keep_records(graph::FrameGraph& frame, const SegmentSamples& samples,
                      const std::vector<std::vector<uint32_t>>& kept);

/// The list of records 0 to count - 1.
RecordList add_list_records(graph::FrameGraph& frame, uint32_t count);

}  // namespace patina
