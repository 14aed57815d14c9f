#include "passes/state/reflectance_state.h"

#include <utility>
#include <vector>

#include "engine/core/error.h"

namespace patina {

namespace {

/// As if one pixel had looked into its direction.
gpu::FarFieldTexel texel_of(glm::vec3 radiance) {
    constexpr float kMost = 4e9f / gpu::kFarFieldSteps;
    const glm::vec3 steps = glm::clamp(radiance, 0.0f, kMost) * gpu::kFarFieldSteps + 0.5f;
    return {{glm::uvec3(steps), 1}};
}

}  // namespace

ReflectanceState::ReflectanceState(vulkan::Device& device, const ObservationMap& map)
    : status_(device.create_buffer(
          {.name = "reflectance.status", .bytes = map.capacity_records() * sizeof(gpu::RecordStatus)})),
      gathered_(device.create_buffer(
          {.name = "reflectance.gathered", .bytes = map.capacity_records() * sizeof(gpu::RecordSurroundings)})),
      windows_(
          device.create_buffer({.name = "reflectance.windows", .bytes = gpu::kWindows * sizeof(gpu::RefreshWindow)})),
      surroundings_(device.create_buffer({.name = "reflectance.surroundings", .bytes = kSurroundingsBytes})) {}

void ReflectanceState::reset(graph::FrameGraph& frame) {
    stamp_ = 0;
    ReflectanceStateIds ids = import(frame);
    ids.status = frame.fill(ids.status, 0);
    ids.gathered = frame.fill(ids.gathered, 0);
    ids.windows = frame.fill(ids.windows, 0);
    if (!has_low_exposure_) ids.surroundings = frame.fill(ids.surroundings, 0);
    keep(frame, ids);
}

graph::BufferId ReflectanceState::import_surroundings(graph::FrameGraph& frame) {
    const graph::BufferId surroundings = frame.import(surroundings_);
    if (std::exchange(has_low_exposure_, true)) return surroundings;
    return frame.fill(surroundings, 0);
}

void ReflectanceState::replace_surroundings(graph::FrameGraph& frame, ReflectanceStateIds& ids,
                                            std::span<const glm::vec3> far_field) {
    ids.surroundings = frame.fill(ids.surroundings, 0);
    if (far_field.empty()) return;
    if (far_field.size() != gpu::kFarFieldTexels)
        throw Error("light from far away has ", far_field.size(), " directions instead of ", gpu::kFarFieldTexels);
    std::vector<gpu::FarFieldTexel> texels;
    texels.reserve(far_field.size());
    for (const glm::vec3& radiance : far_field) texels.push_back(texel_of(radiance));
    ids.surroundings = frame.upload_bytes(ids.surroundings, 0, std::as_bytes(std::span(texels)), false);
}

void ReflectanceState::enlarge(graph::Enlargement& enlargement, uint32_t records) {
    enlargement.add(status_, records * sizeof(gpu::RecordStatus), {.fill = 0});
    enlargement.add(gathered_, records * sizeof(gpu::RecordSurroundings), {.fill = 0});
}

ReflectanceStateIds ReflectanceState::import(graph::FrameGraph& frame) const {
    return {frame.import(status_), frame.import(gathered_), frame.import(windows_), frame.import(surroundings_)};
}

void ReflectanceState::keep(graph::FrameGraph& frame, const ReflectanceStateIds& ids) {
    frame.keep(ids.status);
    frame.keep(ids.gathered);
    frame.keep(ids.windows);
    frame.keep(ids.surroundings);
}

void ReflectanceState::visit(graph::StateVisitor& visitor) {
    visitor.value("reflectance.stamp", stamp_);
    visitor.value("reflectance.has_low_exposure", has_low_exposure_);
    visitor.buffer(status_);
    visitor.buffer(gathered_);
    visitor.buffer(windows_);
    visitor.buffer(surroundings_);
}

}  // namespace patina
