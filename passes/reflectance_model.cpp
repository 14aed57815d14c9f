#include "passes/reflectance_model.h"

#include "passes/shading/pack_records.h"
#include "shared/voxel_map.h"

namespace patina {
namespace {

ObservationMapSettings observations_of(const VoxelMap& map, const ReflectanceModelSettings& settings) {
    ObservationMapSettings observations;
    observations.voxel_m = settings.voxel_m;
    observations.block_m = map.settings().voxel_m * gpu::kBlockEdge;
    observations.capacity_blocks = settings.capacity_blocks;
    observations.capacity_records = settings.capacity_records;
    observations.limit_blocks = settings.limit_blocks;
    observations.limit_records = settings.limit_records;
    return observations;
}

}  // namespace

ReflectanceModel::ReflectanceModel(vulkan::Device& device, const VoxelMap& map,
                                   const ReflectanceModelSettings& settings)
    : map_(map),
      settings_(settings),
      observations_(device, observations_of(map, settings)),
      materials_(device, settings.capacity_labels),
      state_(device, observations_),
      access_(preferred_reflectance_access(device.caps(), map, observations_)) {}

void ReflectanceModel::set_lights(std::span<const PointLight> lights, glm::vec3 ambient) {
    lights_.set(lights, ambient);
}

void ReflectanceModel::set_material(uint32_t label, glm::vec3 ks, float alpha) { materials_.set(label, ks, alpha); }

void ReflectanceModel::reset(graph::Frame& frame, glm::dvec3 center_m) {
    observations_.reset(frame, center_m);
    state_.reset(frame);
    // Uploaded before a frame that replaces them.
    materials_.import(frame);
}

void ReflectanceModel::enlarge_blocks(graph::Enlargement& enlargement, uint32_t blocks) {
    observations_.enlarge_blocks(enlargement, blocks);
}

void ReflectanceModel::enlarge_records(graph::Enlargement& enlargement, uint32_t records) {
    observations_.enlarge_records(enlargement, records);
    state_.enlarge(enlargement, records);
}

RecordList ReflectanceModel::add(graph::Frame& frame, const VoxelMapIds& voxels, const ObservationInputs& inputs,
                                 const gpu::Camera& depth_camera, const gpu::Camera& color_camera,
                                 uint32_t frame_index) {
    ObservationMapIds records = observations_.import(frame);
    const CollectedRecords collected = add_collect_observations(
        frame, observations_, records, inputs, settings_.observe, depth_camera, color_camera, frame_index);
    add_refine_reflectance(frame, models(), voxels, records, collected.changed, access_, settings_.refine);
    ObservationMap::keep(frame, records);
    return collected.changed;
}

SpecularInputs ReflectanceModel::add_specular_inputs(graph::Frame& frame) {
    return {observations_,         observations_.import(frame), state_.import(frame).status,
            lights_.upload(frame), lights_.position_version(),  materials_.import(frame),
            materials_.capacity()};
}

void ReflectanceModel::refine_all(graph::Frame& frame, const VoxelMapIds& voxels) {
    ObservationMapIds records = observations_.import(frame);
    add_refine_all_reflectance(frame, models(), voxels, records, access_, settings_.refine);
    ObservationMap::keep(frame, records);
}

void ReflectanceModel::relight(graph::Frame& frame, const VoxelMapIds& voxels, std::span<const PointLight> lights,
                               glm::vec3 ambient) {
    lights_.set(lights, ambient);
    settings_.refine.albedo = false;
    refine_all(frame, voxels);
}

PredictedView ReflectanceModel::add_predict(graph::Frame& frame, const VoxelMapIds& voxels,
                                            const VisibleBlocks& visible, const RaycastImages& cast) {
    PredictRadianceInputs inputs;
    inputs.position_m = cast.position_m;
    inputs.normal = cast.normal;
    inputs.view = visible.view;
    inputs.view_grid = visible.grid;
    inputs.lights = lights_.upload(frame);
    inputs.most_lights = static_cast<uint32_t>(lights_.point_lights().size());
    inputs.materials = materials_.import(frame);
    inputs.material_count = materials_.capacity();
    const ObservationMapIds records = observations_.import(frame);
    inputs.segments = add_average_segments(frame, observations_, records, materials_.capacity());
    inputs.shadows = settings_.refine.shadows;
    inputs.access = access_.voxels;
    return {add_predict_radiance(frame, map_, voxels, observations_, records, state_.import(frame), inputs),
            inputs.segments};
}

SegmentIds ReflectanceModel::add_segments(graph::Frame& frame) {
    return {add_average_segments(frame, observations_, observations_.import(frame), materials_.capacity()),
            materials_.import(frame)};
}

graph::BufferId ReflectanceModel::add_sample(graph::Frame& frame, graph::BufferId positions_m, graph::BufferId normals,
                                             uint32_t points) {
    const ObservationMapIds records = observations_.import(frame);
    const SampleReflectanceInputs inputs{positions_m,
                                         normals,
                                         add_pack_records(frame, observations_, records, state_.import(frame)),
                                         add_average_segments(frame, observations_, records, materials_.capacity()),
                                         points,
                                         materials_.capacity()};
    return add_sample_reflectance(frame, observations_, records, inputs);
}

}  // namespace patina
