#include "passes/observation/update_records.h"

#include <array>

#include "spirv/shaders.h"

namespace patina {

namespace {

/// True where the colour camera sees past what hides a point from it, or hides it, other than the depth camera does.
bool is_apart(const gpu::ObservationParams& params) {
    const auto center = [](const gpu::Camera& camera) { return glm::inverse(camera.camera_from_world)[3]; };
    return glm::distance(center(params.depth_camera), center(params.color_camera)) > 1e-4f;
}

}  // namespace

RecordList add_update_records(graph::FrameGraph& frame, const ObservationMap& map, ObservationMapIds& ids,
                              const ObservationInputs& inputs, const RecordList& visible, graph::BufferId params,
                              const gpu::ObservationParams& values) {
    const uint64_t visited = uint64_t{values.visited.x} * values.visited.y;
    RecordList changed{create_list(frame, "observation.changed_list", visited),
                       create_list_arguments(frame, "observation.changed_and_stale", 2)};
    graph::BufferId stale = create_list(frame, "observation.stale", visited);
    constexpr uint32_t kUnknown = 0;
    const graph::ImageId labels = inputs.labels ? *inputs.labels
                                                : frame.upload("observation.no_labels", {{1, 1}, vulkan::Format::kR32u},
                                                               std::as_bytes(std::span(&kUnknown, 1)));

    auto collect = frame.compute("observation.collect", spirv::collect_observations);
    collect.read("position_m", inputs.position_m).read("normal", inputs.normal);
    collect.read("depth_m", inputs.depth_m).read("slope", inputs.slope).read("color_linear", inputs.color_linear);
    collect.read("labels", labels).read("Observation", params).read("Visible", visible.list);
    collect.specialise("kVoxelChunks", map.chunks()).specialise("kColorApart", is_apart(values) ? 1 : 0);
    ids.records = collect.modify("Records", ids.records);
    ids.changed = collect.modify("Changed", ids.changed);
    ids.directions = collect.modify("Directions", ids.directions);
    ids.colors = collect.modify("Colors", ids.colors);
    changed.list = collect.modify("ChangedList", changed.list);
    stale = collect.modify("Stale", stale);
    changed.arguments = collect.modify("Arguments", changed.arguments);
    collect.dispatch_indirect(visible.arguments);

    auto closest = frame.compute("observation.find_closest_pair", spirv::find_closest_pair);
    closest.read("Stale", stale).push(values.grid);
    closest.specialise("kVoxelChunks", map.chunks());
    ids.directions = closest.modify("Directions", ids.directions);
    closest.dispatch_indirect(changed.arguments, sizeof(glm::uvec4));
    return changed;
}

}  // namespace patina
