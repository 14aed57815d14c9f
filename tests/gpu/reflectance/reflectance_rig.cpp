#include "tests/gpu/reflectance/reflectance_rig.h"

#include <algorithm>
#include <cstddef>
#include <tuple>

#include <glm/gtc/packing.hpp>

#include "passes/reflectance/average_segments.h"
#include "passes/reflectance/surface_albedo.h"

namespace patina {

namespace {

glm::dvec3 unpack_normal(uint32_t word) {
    const glm::dvec2 at(static_cast<int16_t>(word & 0xffff) / 32767.0, static_cast<int16_t>(word >> 16) / 32767.0);
    glm::dvec3 normal(at, 1 - std::abs(at.x) - std::abs(at.y));
    if (normal.z < 0) {
        normal.x = (1 - std::abs(at.y)) * (at.x >= 0 ? 1 : -1);
        normal.y = (1 - std::abs(at.x)) * (at.y >= 0 ? 1 : -1);
    }
    return glm::normalize(normal);
}

RefinedRecord unpack(const gpu::VoxelRecord& record, const ObservationMap& map) {
    const uint32_t shift = map.edge_shift(), mask = (1u << shift) - 1, number = record.state >> 5 & 63;
    const glm::ivec3 block =
        glm::ivec3(record.block_key & 2047, record.block_key >> 11 & 1023, record.block_key >> 21) -
        glm::ivec3(1024, 512, 1024) + glm::ivec3(map.grid().origin_block);
    RefinedRecord result;
    result.voxel = block * (1 << shift) + glm::ivec3(number & mask, number >> shift & mask, number >> 2 * shift);
    result.normal = unpack_normal(record.normal);
    const double offset = static_cast<int16_t>(record.state >> 16) / 32767.0;
    result.point_m = (glm::dvec3(result.voxel) + 0.5 + result.normal * offset) * double{map.settings().voxel_m};
    result.observations = record.state & 31;
    result.label = record.label & 0xffff;
    return result;
}

glm::dvec3 unpack_certainty(uint32_t word) {
    return glm::dvec3(word & 1023, word >> 10 & 1023, word >> 20 & 1023) / 1023.0;
}

reference::GatheredRays unpack_rays(glm::uvec2 words) {
    return {glm::dvec3(glm::unpackHalf2x16(words.x), glm::unpackHalf2x16(words.y).x), words.y >> 16 & 255,
            words.y >> 24};
}

}  // namespace

ReflectanceRig::ReflectanceRig(vulkan::Device& device, graph::Runner& runner, const VoxelMap& voxel_map,
                               const ObservationMap& observation_map)
    : materials(device, 64),
      access(preferred_reflectance_access(device.caps(), voxel_map, observation_map)),
      runner_(runner),
      voxel_map_(voxel_map),
      observation_map_(observation_map),
      state_(device, observation_map) {
    graph::FrameGraph frame = runner_.begin();
    state_.reset(frame);
    runner_.submit(std::move(frame));
}

glm::uvec2 pack_rays(const reference::GatheredRays& rays) {
    const glm::vec3 mean(rays.mean);
    return {glm::packHalf2x16({mean.r, mean.g}), glm::packHalf2x16({mean.b, 0}) | rays.met << 16 | rays.missed << 24};
}

void ReflectanceRig::set_incident(uint32_t count, const reference::GatheredRays& rays) {
    set_incident(std::vector(count, rays));
}

void ReflectanceRig::set_incident(const std::vector<reference::GatheredRays>& rays) {
    change_status([&](std::vector<gpu::RecordStatus>& status) {
        for (size_t i = 0; i < rays.size(); ++i) status[i].incident = pack_rays(rays[i]);
    });
}

void ReflectanceRig::set_bright(const std::vector<glm::vec3>& radiance) {
    change_status([&](std::vector<gpu::RecordStatus>& status) {
        for (size_t i = 0; i < radiance.size(); ++i) status[i].bright = glm::packF3x9_E1x5(radiance[i]);
    });
}

void ReflectanceRig::change_status(const std::function<void(std::vector<gpu::RecordStatus>&)>& change_all) {
    graph::FrameGraph before = runner_.begin();
    const graph::Readback read = before.read_back(state_.import(before).status);
    runner_.submit(std::move(before));
    runner_.wait();
    auto status = read.as<gpu::RecordStatus>();
    change_all(status);
    change([&](graph::FrameGraph& frame, ReflectanceStateIds& state) {
        state.status = frame.upload_bytes(state.status, 0, std::as_bytes(std::span(status)), false);
    });
}

void ReflectanceRig::share_albedo(const glm::vec4& cube_m) {
    change([&](graph::FrameGraph& frame, ReflectanceStateIds& state) {
        add_surface_albedo(frame, observation_map_, observation_map_.import(frame), state, lights.upload(frame),
                           cube_m);
    });
}

void ReflectanceRig::change(const std::function<void(graph::FrameGraph&, ReflectanceStateIds&)>& add) {
    graph::FrameGraph frame = runner_.begin();
    ReflectanceStateIds state = state_.import(frame);
    add(frame, state);
    ReflectanceState::keep(frame, state);
    runner_.submit(std::move(frame));
    runner_.wait();
}

void ReflectanceRig::set_mirror(uint32_t label, float mirror) {
    set_of_material(label, offsetof(gpu::SegmentMaterial, mirror), mirror);
}

void ReflectanceRig::set_unobserved(uint32_t label, float share) {
    set_of_material(label, offsetof(gpu::SegmentMaterial, unobserved), share);
}

void ReflectanceRig::set_of_material(uint32_t label, uint64_t offset, float value) {
    graph::FrameGraph upload = runner_.begin();
    materials.import(upload);
    runner_.submit(std::move(upload));
    graph::FrameGraph frame = runner_.begin();
    const uint64_t at = label * sizeof(gpu::SegmentMaterial) + offset;
    frame.keep(frame.upload_bytes(materials.import(frame), at, std::as_bytes(std::span(&value, 1)), false));
    runner_.submit(std::move(frame));
    runner_.wait();
}

ReflectanceRig::Counts ReflectanceRig::submit(graph::FrameGraph frame, const ObservationMapIds& ids,
                                              const RefinedReflectance& refined) {
    ObservationMap::keep(frame, ids);
    const graph::Readback marched = frame.read_back(refined.marched.list, 0, 4),
                          albedos = frame.read_back(refined.refined.list, 0, 4);
    runner_.submit(std::move(frame));
    runner_.wait();
    return {marched.as<uint32_t>().front(), albedos.as<uint32_t>().front()};
}

ReflectanceRig::Counts ReflectanceRig::update(const ReflectanceSettings& settings, const Fill& fill) {
    graph::FrameGraph frame = runner_.begin();
    ObservationMapIds ids = observation_map_.import(frame);
    const RecordList changed = fill ? fill(frame, ids) : create_record_list(frame, "none", 1);
    const RefinedReflectance refined =
        add_refine_reflectance(frame, models(), voxel_map_.import(frame), ids, changed, access, settings);
    return submit(std::move(frame), ids, refined);
}

ReflectanceRig::Counts ReflectanceRig::update_all(const ReflectanceSettings& settings) {
    graph::FrameGraph frame = runner_.begin();
    ObservationMapIds ids = observation_map_.import(frame);
    const RefinedReflectance refined =
        add_refine_all_reflectance(frame, models(), voxel_map_.import(frame), ids, access, settings);
    return submit(std::move(frame), ids, refined);
}

void ReflectanceRig::relight(const RelightTurn& turn) {
    graph::FrameGraph frame = runner_.begin();
    ObservationMapIds ids = observation_map_.import(frame);
    VoxelMapIds voxels = voxel_map_.import(frame);
    if (turn.finds_visibility) voxels.color = frame.fill(voxels.color, 0);
    const graph::BufferId segments = add_average_segments(frame, observation_map_, ids, materials.capacity());
    add_relight_reflectance(frame, models(), voxels, ids, segments, access, {}, turn);
    VoxelMap::keep(frame, voxels);
    ObservationMap::keep(frame, ids);
    runner_.submit(std::move(frame));
    runner_.wait();
}

std::vector<RefinedRecord> ReflectanceRig::records(uint32_t count) {
    graph::FrameGraph frame = runner_.begin();
    const ObservationMapIds ids = observation_map_.import(frame);
    const graph::Readback records_read = frame.read_back(ids.records), albedo_read = frame.read_back(ids.albedo),
                          visibility_read = frame.read_back(ids.visibility),
                          status_read = frame.read_back(state_.import(frame).status),
                          gathered_read = frame.read_back(state_.import(frame).gathered);
    runner_.submit(std::move(frame));
    runner_.wait();
    const auto stored = records_read.as<gpu::VoxelRecord>();
    const auto albedo = albedo_read.as<glm::uvec2>(), visibility = visibility_read.as<glm::uvec2>();
    const auto status = status_read.as<gpu::RecordStatus>();
    const auto gathered = gathered_read.as<gpu::RecordSurroundings>();
    const auto bits = [](glm::uvec2 words) { return words.x | uint64_t{words.y} << 32; };
    std::vector<RefinedRecord> records;
    for (uint32_t i = 0; i < count; ++i) {
        RefinedRecord record = unpack(stored[i], observation_map_);
        record.albedo = albedo[i];
        record.raw_kd = glm::dvec3(glm::unpackF3x9_E1x5(albedo[i].x));
        record.kd = glm::min(record.raw_kd, 1.0);
        record.certainty = unpack_certainty(albedo[i].y);
        record.visible = bits(visibility[i]);
        record.uncertain = bits(status[i].uncertain);
        record.gathered = unpack_rays(gathered[i].rays);
        record.around = glm::dvec3(glm::unpackF3x9_E1x5(gathered[i].around));
        record.incident = unpack_rays(status[i].incident);
        record.bright = glm::dvec3(glm::unpackF3x9_E1x5(status[i].bright));
        records.push_back(record);
    }
    return records;
}

std::vector<RefinedRecord> ReflectanceRig::records() {
    graph::FrameGraph frame = runner_.begin();
    const graph::Readback counters = frame.read_back(observation_map_.import(frame).record_counters);
    runner_.submit(std::move(frame));
    runner_.wait();
    std::vector<RefinedRecord> all = records(counters.as<gpu::MapCounters>().front().high_water);
    std::sort(all.begin(), all.end(), [](const RefinedRecord& a, const RefinedRecord& b) {
        return std::tie(a.voxel.x, a.voxel.y, a.voxel.z) < std::tie(b.voxel.x, b.voxel.y, b.voxel.z);
    });
    return all;
}

}  // namespace patina
