#include "reconstruction/stages/reflectance_stage.h"

#include <cmath>

#include "passes/observation/reclaim_records.h"
#include "passes/reflectance/collect_far_field.h"
#include "passes/reflectance/collect_surroundings.h"
#include "passes/reflectance/mark_blocks.h"
#include "passes/reflectance/surface_albedo.h"
#include "passes/shading/pack_records.h"
#include "passes/shading/reflect_surroundings.h"
#include "passes/shading/sample_coverage.h"
#include "shared/fusion/voxel_map.h"

namespace patina {
namespace {

constexpr float kUsualRecord_m = 0.02f;
constexpr uint32_t kRelitRays = 16, kRelitRaysAtTheEnd = 64;  // of a record, under lights that no frame showed

/// With the records' size, where it was left open.
ReflectanceStageSettings whole(const VoxelMap& map, ReflectanceStageSettings settings) {
    const float half_block_m = map.settings().voxel_m * gpu::kBlockEdge / 2;
    // The ratio decides: twice too large is as bad as half.
    const bool too_large = half_block_m > std::sqrt(2.0f) * kUsualRecord_m;
    if (settings.voxel_m == 0) settings.voxel_m = too_large ? half_block_m / 2 : half_block_m;
    return settings;
}

ObservationMapSettings observations_of(const VoxelMap& map, const ReflectanceStageSettings& settings) {
    ObservationMapSettings observations;
    observations.voxel_m = settings.voxel_m;
    observations.block_m = map.settings().voxel_m * gpu::kBlockEdge;
    observations.capacity_blocks = settings.capacity_blocks;
    observations.capacity_records = settings.capacity_records;
    observations.limit_blocks = settings.limit_blocks;
    observations.limit_records = settings.limit_records;
    return observations;
}

/// The records around the camera, whose way to their lights begins where the map is known.
RefinedPart part_around(const FrameContext& frame) {
    const glm::vec3 center_m(frame.around.center_m);
    const auto radius_m = static_cast<float>(frame.shadows_m);
    return {glm::vec4(center_m, radius_m), glm::vec4(center_m, radius_m / std::sqrt(3.0f))};
}

}  // namespace

ReflectanceStage::ReflectanceStage(vulkan::Device& device, const VoxelMap& map,
                                   const ReflectanceStageSettings& settings)
    : map_(map),
      settings_(whole(map, settings)),
      observations_(device, observations_of(map, settings_)),
      materials_(device, settings.capacity_labels),
      state_(device, observations_),
      away_(device, settings.capacity_labels),
      access_(preferred_reflectance_access(device.caps(), map, observations_)) {}

void ReflectanceStage::set_lights(std::span<const Light> lights, glm::dvec3 ambient) { lights_.set(lights, ambient); }

void ReflectanceStage::set_material(uint32_t label, glm::vec3 ks, float alpha) { materials_.set(label, ks, alpha); }

void ReflectanceStage::reset(graph::FrameGraph& graph, glm::dvec3 center_m) {
    observations_.reset(graph, center_m);
    state_.reset(graph);
    away_.reset(graph);
    any_left_ = false;
    shared_ = false;
    reclaim_at_ = settings_.reclaim_every;
    reclaim_turn_ = 0;
    // Uploaded before a frame that replaces them.
    materials_.import(graph);
}

void ReflectanceStage::enlarge_blocks(graph::Enlargement& enlargement, uint32_t blocks) {
    observations_.enlarge_blocks(enlargement, blocks);
}

void ReflectanceStage::enlarge_records(graph::Enlargement& enlargement, uint32_t records) {
    observations_.enlarge_records(enlargement, records);
    state_.enlarge(enlargement, records);
}

void ReflectanceStage::enlarge_labels(graph::Enlargement& enlargement, uint32_t labels) {
    materials_.enlarge(enlargement, labels);
    away_.enlarge(enlargement, labels);
}

LeavingRecords ReflectanceStage::add_leave(graph::FrameGraph& graph, const gpu::StreamRegion& region, uint32_t most) {
    any_left_ = true;
    ObservationMapIds records = observations_.import(graph);
    ReflectanceStateIds state = state_.import(graph);
    graph::BufferId away = away_.import(graph);
    return add_leave_records(graph, {observations_, records, state, away}, map_.grid(), region, most);
}

graph::BufferId ReflectanceStage::add_return(graph::FrameGraph& graph, const ReturningRecords& returning) {
    ObservationMapIds records = observations_.import(graph);
    ReflectanceStateIds state = state_.import(graph);
    graph::BufferId away = away_.import(graph);
    return add_return_records(graph, {observations_, records, state, away}, returning);
}

std::optional<graph::BufferId> ReflectanceStage::away(graph::FrameGraph& graph) const {
    return any_left_ ? std::optional(away_.import(graph)) : std::nullopt;
}

graph::BufferId ReflectanceStage::add_average(graph::FrameGraph& graph, const ObservationMapIds& records) const {
    return add_average_segments(graph, observations_, records, materials_.capacity(), away(graph));
}

void ReflectanceStage::reclaim(graph::FrameGraph& graph, const VoxelMapIds& voxels, float near_m,
                               const FrameContext& frame) {
    if (settings_.reclaim_every == 0 || uint64_t{frame.index} + 1 < reclaim_at_) return;
    reclaim_at_ = uint64_t{frame.index} + 1 + settings_.reclaim_every;
    ObservationMapIds records = observations_.import(graph);
    ReflectanceStateIds state = state_.import(graph);
    add_reclaim_records(graph, observations_, records, state, map_, voxels, near_m, frame.around.gpu(),
                        reclaim_turn_++);
}

void ReflectanceStage::keep(graph::FrameGraph& graph) const {
    ObservationMap::keep(graph, observations_.import(graph));
    ReflectanceState::keep(graph, state_.import(graph));
    if (any_left_) graph.keep(away_.import(graph));
}

void ReflectanceStage::add_low_exposure(graph::FrameGraph& graph, const SurroundingsInputs& frame) {
    if (settings_.refine.gathered_rays == 0) return;
    ReflectanceStateIds state;
    state.surroundings = state_.import_surroundings(graph);
    add_collect_surroundings(graph, state, frame);
    low_exposure_cameras_.push_back(frame.color_camera);
    graph.keep(state.surroundings);
}

RecordList ReflectanceStage::add(graph::FrameGraph& graph, const VoxelMapIds& voxels, const ObservationInputs& inputs,
                                 const FrameContext& frame) {
    shared_ = false;
    ObservationMapIds records = observations_.import(graph);
    ObservationSettings observe = settings_.observe;
    observe.stride_px = frame.stride_px(observe.stride_px, double{settings_.voxel_m});
    const CollectedRecords collected = add_collect_observations(graph, observations_, records, inputs, observe,
                                                                frame.depth.gpu, frame.color.gpu, frame.index);
    if (settings_.refine.gathered_rays > 0 && !frame.precedes) {
        ReflectanceStateIds state = state_.import(graph);
        add_collect_far_field(
            graph, state,
            {inputs.position_m, inputs.depth_m, inputs.color_linear, frame.depth.gpu, frame.color.gpu, frame.index});
        add_collect_surroundings(graph, state,
                                 {inputs.depth_m, inputs.color_linear, frame.depth.gpu, frame.color.gpu, frame.index});
    }
    add_refine_reflectance(graph, models(part_around(frame)), voxels, records, collected.changed, access_,
                           settings_.refine);
    ObservationMap::keep(graph, records);
    if (any_left_) graph.keep(away_.import(graph));
    return collected.changed;
}

SpecularInputs ReflectanceStage::add_specular_inputs(graph::FrameGraph& graph) {
    const ReflectanceStateIds state = state_.import(graph);
    const bool gathers = settings_.refine.gathered_rays > 0;
    return {observations_,
            observations_.import(graph),
            state.status,
            gathers ? std::optional(state.surroundings) : std::nullopt,
            lights_.upload(graph),
            lights_.position_version(),
            materials_.import(graph),
            materials_.capacity()};
}

void ReflectanceStage::refine_all(graph::FrameGraph& graph, const VoxelMapIds& voxels, bool gathers,
                                  const RefinedPart& part) {
    ObservationMapIds records = observations_.import(graph);
    ReflectanceSettings refine = settings_.refine;
    if (!gathers) refine.gathered_rays = 0;
    add_refine_all_reflectance(graph, models(part), voxels, records, access_, refine);
    shared_ = true;
    ObservationMap::keep(graph, records);
}

std::vector<RelightTurn> ReflectanceStage::relight(const Relighting& relighting) {
    lights_.set(relighting.lights, relighting.ambient);
    relit_ = true;
    const bool from_afar = !relighting.far_field.empty(),
               gathers = from_afar || (this->gathers() && relighting.bounces > 0);
    settings_.refine.albedo = false;
    settings_.refine.gathered_rays = gathers ? kRelitRays : 0;
    if (!gathers) return {};
    std::vector<RelightTurn> turns{{.finds_visibility = true}};
    turns.resize(1 + relighting.bounces + (from_afar ? 1 : 0), {.gathered_rays = kRelitRays});
    turns.back().gathered_rays = kRelitRaysAtTheEnd;
    return turns;
}

void ReflectanceStage::add_forget_light(graph::FrameGraph& graph, VoxelMapIds& voxels,
                                        const Relighting& relighting) const {
    voxels.color = graph.fill(voxels.color, 0);
    ReflectanceStateIds state = state_.import(graph);
    ReflectanceState::replace_surroundings(graph, state, relighting.far_field);
    graph.keep(state.surroundings);
}

void ReflectanceStage::add_relight(graph::FrameGraph& graph, VoxelMapIds& voxels, const RelightTurn& turn,
                                   const RefinedPart& part) {
    ObservationMapIds records = observations_.import(graph);
    const graph::BufferId segments = add_average(graph, records);
    add_relight_reflectance(graph, models(part), voxels, records, segments, access_, settings_.refine, turn);
    ObservationMap::keep(graph, records);
}

void ReflectanceStage::share_albedo(graph::FrameGraph& graph) {
    if (!gathers() || shared_) return;
    shared_ = true;
    ReflectanceStateIds state = state_.import(graph);
    add_surface_albedo(graph, observations_, observations_.import(graph), state, lights_.upload(graph),
                       RefinedPart{}.cube_m);
    graph.keep(state.gathered);
}

PredictedView ReflectanceStage::add_predict(graph::FrameGraph& graph, const VoxelMapIds& voxels,
                                            const VisibleBlocks& visible, const RaycastImages& cast,
                                            const OtherLights* other) {
    return predict(graph, voxels, visible, cast, other, {});
}

PredictedView ReflectanceStage::add_predict_mirrors(graph::FrameGraph& graph, const VoxelMapIds& voxels,
                                                    const VisibleBlocks& visible, const RaycastImages& cast,
                                                    glm::vec4 ball_m) {
    PredictRadianceInputs inputs;
    inputs.gloss_apart = settings_.mirrored_rays > 0 && gathers();
    PredictedView view = predict(graph, voxels, visible, cast, nullptr, inputs);
    if (!inputs.gloss_apart) return view;
    ReflectSurroundingsInputs mirrored;
    mirrored.position_m = cast.position_m;
    mirrored.normal = cast.normal;
    mirrored.rgb = view.images.rgb;
    mirrored.glossy = view.images.glossy;
    ReflectanceStateIds state = state_.import(graph);
    add_mark_blocks(graph, state, map_, voxels);
    graph.keep(state.surroundings);
    mirrored.surroundings = state.surroundings;
    mirrored.lights = lights_.upload(graph);
    mirrored.ball_m = ball_m;
    mirrored.rays = settings_.mirrored_rays;
    mirrored.access = access_.voxels;
    view.images.rgb = add_reflect_surroundings(graph, map_, voxels, mirrored);
    return view;
}

PredictedImages ReflectanceStage::add_predict_picture(graph::FrameGraph& graph, const VoxelMapIds& voxels,
                                                      const VisibleBlocks& visible, const RaycastImages& cast) {
    PredictRadianceInputs inputs;
    inputs.of_picture = true;
    return predict(graph, voxels, visible, cast, nullptr, inputs).images;
}

PredictedView ReflectanceStage::predict(graph::FrameGraph& graph, const VoxelMapIds& voxels,
                                        const VisibleBlocks& visible, const RaycastImages& cast,
                                        const OtherLights* other, PredictRadianceInputs inputs) {
    Lights others;
    if (other) others.set(other->lights, other->ambient);
    const Lights& shining = other ? others : lights_;
    inputs.position_m = cast.position_m;
    inputs.normal = cast.normal;
    inputs.view = visible.view;
    inputs.view_grid = visible.grid;
    inputs.lights = shining.upload(graph);
    inputs.most_lights = static_cast<uint32_t>(shining.point_lights().size());
    inputs.materials = materials_.import(graph);
    inputs.material_count = materials_.capacity();
    const ObservationMapIds records = observations_.import(graph);
    inputs.segments = add_average(graph, records);
    inputs.shadows = settings_.refine.shadows && (!other || other->shadows);
    inputs.gathers = gathers() && !other;
    inputs.other_light = relit_;
    inputs.access = access_.voxels;
    return {add_predict_radiance(graph, map_, voxels, observations_, records, state_.import(graph), inputs),
            inputs.segments};
}

graph::ImageId ReflectanceStage::add_coverage(graph::FrameGraph& graph, const VisibleBlocks& visible,
                                              const PredictedImages& predicted, graph::ImageId position_m) const {
    return add_sample_coverage(graph, observations_, observations_.import(graph),
                               {position_m, visible.view, visible.grid, predicted.packed});
}

SegmentIds ReflectanceStage::add_segments(graph::FrameGraph& graph) {
    return {add_average(graph, observations_.import(graph)), materials_.import(graph)};
}

graph::BufferId ReflectanceStage::add_sample(graph::FrameGraph& graph, graph::BufferId positions_m,
                                             graph::BufferId normals, uint32_t points) {
    const ObservationMapIds records = observations_.import(graph);
    const ReflectanceStateIds state = state_.import(graph);
    const SampleReflectanceInputs inputs{positions_m,
                                         normals,
                                         add_pack_records(graph, observations_, records, state),
                                         add_average(graph, records),
                                         state.gathered,
                                         points,
                                         materials_.capacity()};
    return add_sample_reflectance(graph, observations_, records, inputs);
}

std::vector<VoxelMap::PoolBytes> ReflectanceStage::memory() const {
    std::vector<VoxelMap::PoolBytes> memory = observations_.memory();
    memory.push_back({"albedo of what is away", away_.bytes()});
    return memory;
}

void ReflectanceStage::visit(graph::StateVisitor& visitor) {
    observations_.visit(visitor);
    lights_.visit(visitor);
    materials_.visit(visitor);
    state_.visit(visitor);
    away_.visit(visitor);
    visitor.value("reflectance.any_left", any_left_);
    visitor.values("reflectance.low_exposure_cameras", low_exposure_cameras_);
    visitor.value("reflectance.shared", shared_);
    visitor.value("reflectance.reclaim_at", reclaim_at_);
    visitor.value("reflectance.reclaim_turn", reclaim_turn_);
}

}  // namespace patina
