#include "tests/gpu/shading/shading_rig.h"

#include <glm/gtc/packing.hpp>

#include "engine/core/shader_camera.h"
#include "passes/reflectance/average_segments.h"
#include "passes/shading/pack_records.h"
#include "passes/shading/predict_radiance.h"
#include "passes/shading/sample_coverage.h"
#include "passes/shading/sample_reflectance.h"
#include "tests/gpu/reflectance/reflectance_rig.h"

namespace patina {

namespace {

ObservationMapSettings map_settings(float voxel_m) {
    ObservationMapSettings settings;
    settings.voxel_m = voxel_m;
    return settings;
}

ObservationSettings every_pixel() {
    ObservationSettings settings;
    settings.stride_px = 1;
    return settings;
}

double snorm16(uint32_t bits) { return static_cast<int16_t>(bits & 0xffff) / 32767.0; }

reference::ShadedRecord unpack_surface(const gpu::VoxelRecord& record) {
    const double x = snorm16(record.normal), y = snorm16(record.normal >> 16), z = 1 - std::abs(x) - std::abs(y);
    const glm::dvec3 folded(std::copysign(1 - std::abs(y), x), std::copysign(1 - std::abs(x), y), z);
    reference::ShadedRecord result;
    result.normal = glm::normalize(z >= 0 ? glm::dvec3(x, y, z) : folded);
    result.offset_vox = snorm16(record.state >> 16);
    return result;
}

std::array<int, 3> voxel_of(const gpu::VoxelRecord& record, const ObservationMap& map) {
    const reference::BlockCoordinates block = coordinates_of_key(record.block_key);
    const uint32_t shift = map.edge_shift(), mask = (1u << shift) - 1, number = record.state >> 5 & 63;
    std::array<int, 3> voxel{};
    for (uint32_t axis = 0; axis < 3; ++axis) {
        voxel[axis] = block[axis] * (1 << shift) + static_cast<int>(number >> axis * shift & mask);
    }
    return voxel;
}

uint32_t pack_certainty(glm::dvec3 certainty) {
    const glm::uvec3 c(glm::round(certainty * 1023.0));
    return c.r | c.g << 10 | c.b << 20;
}

}  // namespace

ShadingRig::ShadingRig(vulkan::Device& device, graph::Runner& runner, float voxel_m)
    : materials(device, 64),
      voxel_m_(voxel_m),
      runner_(runner),
      observations_(device, runner, map_settings(voxel_m), every_pixel()),
      state_(device, observations_.map()) {
    graph::FrameGraph frame = runner_.begin();
    state_.reset(frame);
    runner_.submit(std::move(frame));
}

const Intrinsics& ShadingRig::camera() {
    static const Intrinsics camera{{160, 120}, 150, 150, 79.5, 59.5, {}};
    return camera;
}

void ShadingRig::see(const reference::DistanceField& field, const RigidTransform& world_from_camera) {
    const Image<glm::vec4> gray(camera().extent, glm::vec4(0.5f, 0.5f, 0.5f, 1));
    const RigFrame frame{camera(),
                         world_from_camera,
                         reference::render_depth(field, camera(), world_from_camera, 5),
                         {camera(), world_from_camera, gray},
                         {}};
    observations_.fuse(frame);
    observations_.collect(frame);
}

ShadingRig::Stored ShadingRig::read() {
    graph::FrameGraph frame = runner_.begin();
    const ObservationMapIds ids = observations_.map().import(frame);
    const graph::Readback records = frame.read_back(ids.records), counters = frame.read_back(ids.record_counters);
    runner_.submit(std::move(frame));
    runner_.wait();
    Stored stored;
    stored.records = records.as<gpu::VoxelRecord>();
    stored.records.resize(counters.as<gpu::MapCounters>().front().high_water);
    return stored;
}

void ShadingRig::write(const Stored& stored) {
    graph::FrameGraph frame = runner_.begin();
    ObservationMapIds ids = observations_.map().import(frame);
    ReflectanceStateIds state = state_.import(frame);
    const auto replace = [&](graph::BufferId id, const auto& values) {
        return frame.upload_bytes(id, 0, std::as_bytes(std::span(values)), false);
    };
    ids.records = replace(ids.records, stored.records);
    ids.albedo = replace(ids.albedo, stored.albedo);
    ids.visibility = replace(ids.visibility, stored.visibility);
    state.status = replace(state.status, stored.status);
    state.gathered = replace(state.gathered, stored.gathered);
    ObservationMap::keep(frame, ids);
    ReflectanceState::keep(frame, state);
    runner_.submit(std::move(frame));
    runner_.wait();
}

void ShadingRig::paint(const std::function<reference::ShadedRecord(const RecordPlace&)>& paint) {
    Stored stored = read();
    for (gpu::VoxelRecord& record : stored.records) {
        const reference::ShadedRecord surface = unpack_surface(record);
        const std::array<int, 3> voxel = voxel_of(record, observations_.map());
        const glm::dvec3 center_vox = glm::dvec3(voxel[0], voxel[1], voxel[2]) + 0.5;
        reference::ShadedRecord painted = paint(
            {voxel, (center_vox + surface.normal * surface.offset_vox) * voxel_m_, surface.normal, record.state & 31});
        painted.normal = surface.normal;
        painted.offset_vox = surface.offset_vox;
        const uint32_t kd = glm::packF3x9_E1x5(glm::vec3(painted.kd));
        stored.albedo.emplace_back(kd, pack_certainty(painted.certainty));
        stored.visibility.emplace_back(painted.reached & 0xffffffff, painted.reached >> 32);
        stored.status.push_back(
            {painted.marched ? 1u : 0u, 0, 0, 0, {0, 0}, incident ? pack_rays(*incident) : glm::uvec2(0), 0, 0});
        const uint32_t around = painted.around ? glm::packF3x9_E1x5(glm::vec3(*painted.around)) : 0;
        stored.gathered.push_back({{}, around, 0});
        if (painted.around) painted.around = glm::dvec3(glm::unpackF3x9_E1x5(around));
        record.label = painted.label;
        painted.kd = glm::dvec3(glm::unpackF3x9_E1x5(kd));
        painted_[voxel] = painted;
    }
    write(stored);
}

void ShadingRig::set_mirror(uint32_t label, float mirror) {
    graph::FrameGraph upload = runner_.begin();
    materials.import(upload);
    runner_.submit(std::move(upload));
    graph::FrameGraph frame = runner_.begin();
    const uint64_t at = label * sizeof(gpu::SegmentMaterial) + offsetof(gpu::SegmentMaterial, mirror);
    frame.keep(frame.upload_bytes(materials.import(frame), at, std::as_bytes(std::span(&mirror, 1)), false));
    runner_.submit(std::move(frame));
    runner_.wait();
}

ShadedView ShadingRig::predict(const Intrinsics& camera, const RigidTransform& world_from_camera, bool shadows) {
    for (const auto& [label, mirror] : mirrors) set_mirror(label, mirror);
    graph::FrameGraph frame = runner_.begin();
    const VoxelMap& map = observations_.fusion().map();
    const VoxelMapIds voxels = map.import(frame);
    const VisibleBlocks visible =
        add_visible_blocks(frame, map, voxels, make_camera(camera, world_from_camera), 0.1f, 5.0f);
    const RaycastImages model = add_raycast(frame, map, voxels, visible, MapAccess::kStorage);
    const PredictRadianceInputs inputs{
        model.position_m,
        model.normal,
        visible.view,
        visible.grid,
        lights.upload(frame),
        materials.import(frame),
        add_average_segments(frame, observations_.map(), observations_.map().import(frame), materials.capacity()),
        materials.capacity(),
        static_cast<uint32_t>(lights.point_lights().size()),
        shadows,
        preferred_map_access(runner_.device().caps(), map),
        incident.has_value(),
        of_picture,
        gloss_apart};
    const PredictedImages predicted = add_predict_radiance(
        frame, map, voxels, observations_.map(), observations_.map().import(frame), state_.import(frame), inputs);
    const graph::Readback position = frame.read_back(model.position_m), normal = frame.read_back(model.normal),
                          kd = frame.read_back(predicted.kd), picture_kd = frame.read_back(predicted.picture_kd),
                          label = frame.read_back(predicted.label), gloss = frame.read_back(predicted.ks_alpha),
                          rgb = frame.read_back(predicted.rgb), light = frame.read_back(predicted.light),
                          coverage = frame.read_back(
                              add_sample_coverage(frame, observations_.map(), observations_.map().import(frame),
                                                  {model.position_m, visible.view, visible.grid, predicted.packed}));
    const graph::Readback glossy = frame.read_back(predicted.glossy);
    runner_.submit(std::move(frame));
    runner_.wait();
    return {position.image<glm::vec4>(),       widen(normal.image<uint64_t>()), widen(kd.image<uint64_t>()),
            widen(gloss.image<uint64_t>()),    widen(rgb.image<uint64_t>()),    widen(light.image<uint64_t>()),
            widen(coverage.image<uint64_t>()), label.image<uint32_t>(),         widen(picture_kd.image<uint64_t>()),
            glossy.as<gpu::GlossyPixel>()};
}

std::vector<gpu::SampledReflectance> ShadingRig::sample(const std::vector<glm::vec3>& points_m,
                                                        const std::vector<glm::vec3>& normals) {
    graph::FrameGraph frame = runner_.begin();
    const ObservationMap& map = observations_.map();
    const ObservationMapIds records = map.import(frame);
    const auto upload = [&](const char* name, const std::vector<glm::vec3>& vectors) {
        return frame.upload<float>(name, std::span(&vectors.front().x, 3 * vectors.size()));
    };
    const SampleReflectanceInputs inputs{upload("points", points_m),
                                         upload("normals", normals),
                                         add_pack_records(frame, map, records, state_.import(frame)),
                                         add_average_segments(frame, map, records, materials.capacity()),
                                         state_.import(frame).gathered,
                                         static_cast<uint32_t>(points_m.size()),
                                         materials.capacity()};
    const graph::Readback samples = frame.read_back(add_sample_reflectance(frame, map, records, inputs));
    runner_.submit(std::move(frame));
    runner_.wait();
    return samples.as<gpu::SampledReflectance>();
}

std::vector<gpu::SegmentAlbedo> ShadingRig::average_segments() {
    graph::FrameGraph frame = runner_.begin();
    const graph::Readback sums = frame.read_back(
        add_average_segments(frame, observations_.map(), observations_.map().import(frame), materials.capacity()));
    runner_.submit(std::move(frame));
    runner_.wait();
    return sums.as<gpu::SegmentAlbedo>();
}

reference::ShadedScene ShadingRig::scene() const {
    reference::ShadedScene scene;
    scene.voxel_m = voxel_m_;
    scene.records = painted_;
    scene.segment_kd = reference::average_segments(painted_);
    for (const gpu::PointLight& light : lights.point_lights()) {
        scene.lights.push_back({glm::dvec3(light.position_m), glm::dvec3(light.intensity), glm::dvec3(light.axis)});
    }
    scene.ambient = glm::dvec3(lights.ambient());
    return scene;
}

}  // namespace patina
