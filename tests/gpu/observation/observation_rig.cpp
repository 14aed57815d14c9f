#include "tests/gpu/observation/observation_rig.h"

#include <cstring>

#include <glm/gtc/packing.hpp>

#include "engine/core/shader_camera.h"
#include "passes/fusion/measure_slope.h"
#include "passes/observation/reclaim_records.h"
#include "shared/fusion/remove_empty_blocks.h"
#include "shared/test/test_observations.h"
#include "spirv/shaders.h"

namespace patina {

bool RecordContent::operator==(const RecordContent& other) const {
    return std::memcmp(&record, &other.record, sizeof(record)) == 0 && directions == other.directions &&
           colors == other.colors && changed == other.changed;
}

ObservationRig::ObservationRig(vulkan::Device& device, graph::Runner& runner, const ObservationMapSettings& map,
                               const ObservationSettings& settings, const FusionSettings& fusion,
                               const VoxelMapSettings& voxels)
    : runner_(runner),
      fusion_(device, runner, voxels, fusion),
      map_(device, map),
      state_(device, map_),
      settings_(settings) {
    graph::FrameGraph frame = runner_.begin();
    map_.reset(frame, glm::dvec3(0));
    state_.reset(frame);
    runner_.submit(std::move(frame));
}

void ObservationRig::fuse(const RigFrame& frame, int times) {
    for (int i = 0; i < times; ++i) fusion_.fuse(frame.camera, frame.world_from_camera, frame.depth_m);
}

ObservationRig::Collected ObservationRig::collect(const RigFrame& rig_frame) {
    graph::FrameGraph frame = runner_.begin();
    const Extent2D extent = rig_frame.camera.extent;
    ObservationInputs inputs;
    inputs.depth_m =
        frame.upload("depth", {extent, vulkan::Format::kR32f}, std::as_bytes(std::span(rig_frame.depth_m.pixels())));
    inputs.slope = add_measure_slope(frame, inputs.depth_m, rig_frame.camera);
    std::vector<uint64_t> halves;
    for (const glm::vec4& pixel : rig_frame.color.linear.pixels()) halves.push_back(glm::packHalf4x16(pixel));
    inputs.color_linear = frame.upload("color", {rig_frame.color.camera.extent, vulkan::Format::kRgba16f},
                                       std::as_bytes(std::span(halves)));
    if (rig_frame.labels) {
        inputs.labels = frame.upload("labels", {extent, vulkan::Format::kR32u},
                                     std::as_bytes(std::span(rig_frame.labels->pixels())));
    }
    inputs.motion = rig_frame.motion;
    const gpu::Camera camera = make_camera(rig_frame.camera, rig_frame.world_from_camera);
    const VoxelMapIds voxels = fusion_.map().import(frame);
    const VisibleBlocks visible = add_visible_blocks(frame, fusion_.map(), voxels, camera, 0.1f, 8.0f);
    const RaycastImages model = add_raycast(frame, fusion_.map(), voxels, visible, MapAccess::kStorage);
    inputs.position_m = model.position_m;
    inputs.normal = model.normal;
    ObservationMapIds ids = map_.import(frame);
    const CollectedRecords collected =
        add_collect_observations(frame, map_, ids, inputs, settings_, camera,
                                 make_camera(rig_frame.color.camera, rig_frame.color.world_from_camera), frame_++);
    ObservationMap::keep(frame, ids);
    const graph::Readback seen = frame.read_back(collected.visible.list, 0, 4),
                          changed = frame.read_back(collected.changed.list, 0, 4),
                          position = frame.read_back(model.position_m), normal = frame.read_back(model.normal);
    runner_.submit(std::move(frame));
    runner_.wait();
    return {seen.as<uint32_t>().front(), changed.as<uint32_t>().front(), position.image<glm::vec4>(),
            widen(normal.image<uint64_t>())};
}

void ObservationRig::reclaim(uint32_t turn, float near, const StreamRegion& region) {
    graph::FrameGraph frame = runner_.begin();
    ObservationMapIds ids = map_.import(frame);
    ReflectanceStateIds state = state_.import(frame);
    const float near_m = near * fusion_.settings().truncation_m;
    const VoxelMapIds voxels = fusion_.map().import(frame);
    add_reclaim_records(frame, map_, ids, state, fusion_.map(), voxels, near_m, region.gpu(), turn);
    ObservationMap::keep(frame, ids);
    ReflectanceState::keep(frame, state);
    runner_.submit(std::move(frame));
    runner_.wait();
}

ObservationRig::PoolIds ObservationRig::pool_ids(graph::BufferId ObservationMapIds::*free_list,
                                                 const gpu::MapCounters& counters) {
    graph::FrameGraph frame = runner_.begin();
    const ObservationMapIds ids = map_.import(frame);
    const graph::Readback free = frame.read_back(ids.*free_list), keys = frame.read_back(ids.block_keys),
                          table = frame.read_back(ids.record_table);
    runner_.submit(std::move(frame));
    runner_.wait();
    PoolIds pool;
    pool.free = free.as<uint32_t>();
    pool.free.resize(counters.free_blocks);
    const auto block_keys = keys.as<uint32_t>(), entries = table.as<uint32_t>();
    const size_t per_block = size_t{1} << 3 * map_.edge_shift();
    for (uint32_t block = 0; block < block_keys.size(); ++block) {
        if (block_keys[block] == gpu::kEmptyKey) continue;
        if (free_list == &ObservationMapIds::free_blocks) {
            pool.used.push_back(block);
            continue;
        }
        for (size_t i = block * per_block; i < (block + 1) * per_block; ++i) {
            if (entries[i] < gpu::kNewRecord) pool.used.push_back(entries[i]);
        }
    }
    return pool;
}

ObservationRig::PoolIds ObservationRig::block_ids() {
    return pool_ids(&ObservationMapIds::free_blocks, block_counters());
}
ObservationRig::PoolIds ObservationRig::record_ids() {
    return pool_ids(&ObservationMapIds::free_records, record_counters());
}

gpu::MapCounters ObservationRig::read(graph::BufferId ObservationMapIds::*counters) {
    graph::FrameGraph frame = runner_.begin();
    const graph::Readback read = frame.read_back(map_.import(frame).*counters);
    runner_.submit(std::move(frame));
    runner_.wait();
    return read.as<gpu::MapCounters>().front();
}

gpu::MapCounters ObservationRig::block_counters() { return read(&ObservationMapIds::block_counters); }
gpu::MapCounters ObservationRig::record_counters() { return read(&ObservationMapIds::record_counters); }

std::vector<gpu::VoxelRecord> ObservationRig::find(const std::vector<glm::ivec4>& voxels) {
    graph::FrameGraph frame = runner_.begin();
    const ObservationMapIds ids = map_.import(frame);
    auto find = frame.compute("test.find_records", spirv::test_find_records);
    find.read("Voxels", frame.upload<glm::ivec4>("voxels", voxels)).read("Keys", ids.keys).read("Blocks", ids.blocks);
    find.read("RecordTable", ids.record_table).read("Records", ids.records);
    const auto found = find.create("Found", voxels.size() * sizeof(gpu::VoxelRecord));
    const auto count = static_cast<uint32_t>(voxels.size());
    find.push(gpu::TestObservationParams{map_.grid(), count, map_.edge_shift(), 0, 0});
    find.dispatch_covering(count);
    const graph::Readback read = frame.read_back(found);
    runner_.submit(std::move(frame));
    runner_.wait();
    return read.as<gpu::VoxelRecord>();
}

ObservationContent ObservationRig::content() {
    const uint32_t blocks = block_counters().high_water, count = std::max(record_counters().high_water, 1u);
    graph::FrameGraph frame = runner_.begin();
    const ObservationMapIds ids = map_.import(frame);
    auto gather = frame.compute("test.gather_records", spirv::test_gather_records);
    gather.read("Directions", ids.directions).read("Colors", ids.colors);
    gather.specialise("kVoxelChunks", map_.chunks());
    const auto directions_id = gather.create("GatheredDirections", count * gpu::kRecordQuads * 16);
    const auto colors_id = gather.create("GatheredColors", count * gpu::kRecordQuads * 16);
    gather.push(gpu::TestObservationParams{map_.grid(), count, 0, 0, 0});
    gather.dispatch_covering(count);
    const graph::Readback directions_read = frame.read_back(directions_id), colors_read = frame.read_back(colors_id),
                          keys_read = frame.read_back(ids.block_keys), table_read = frame.read_back(ids.record_table),
                          records_read = frame.read_back(ids.records), changed_read = frame.read_back(ids.changed);
    runner_.submit(std::move(frame));
    runner_.wait();

    const auto directions = directions_read.as<uint32_t>(), colors = colors_read.as<uint32_t>(),
               keys = keys_read.as<uint32_t>(), table = table_read.as<uint32_t>(),
               changed = changed_read.as<uint32_t>();
    const auto records = records_read.as<gpu::VoxelRecord>();
    const uint32_t edge = 1u << map_.edge_shift(), per_block = edge * edge * edge;
    ObservationContent content;
    for (uint32_t entry = 0; entry < blocks * per_block; ++entry) {
        const uint32_t id = table[entry], voxel = entry % per_block;
        if (keys[entry / per_block] == gpu::kEmptyKey || id >= gpu::kNewRecord) continue;
        const reference::BlockCoordinates block = coordinates_of_key(keys[entry / per_block]);
        const std::array<uint32_t, 3> within{voxel % edge, voxel / edge % edge, voxel / edge / edge};
        std::array<int, 3> at{};
        for (size_t axis = 0; axis < 3; ++axis) {
            at[axis] = block[axis] * static_cast<int>(edge) + static_cast<int>(within[axis]);
        }
        RecordContent& record = content[at];
        record.record = records[id];
        record.changed = changed[id];
        const ptrdiff_t first = ptrdiff_t{id} * gpu::kRecordQuads * 4;
        record.directions.assign(directions.begin() + first, directions.begin() + first + record.count());
        record.colors.assign(colors.begin() + first, colors.begin() + first + record.count());
    }
    return content;
}

}  // namespace patina
