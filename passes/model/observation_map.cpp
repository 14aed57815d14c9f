#include "passes/model/observation_map.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/core/error.h"

namespace patina {

namespace {

constexpr uint32_t kQuadBytes = gpu::kRecordQuads * 16;  // of a record's directions, and of its colours

/// log2 of the voxels along a block's edge.
uint32_t edge_shift_of(const ObservationMapSettings& settings) {
    const double edge = double{settings.block_m} / double{settings.voxel_m};
    for (const uint32_t shift : {1u, 2u}) {
        if (std::abs(edge - (1u << shift)) < 1e-3) return shift;
    }
    throw Error("the observations' voxels are ", settings.voxel_m, " m, they must be ", settings.block_m / 2, " or ",
                settings.block_m / 4, " m, half or a quarter of a block");
}

void check_capacity(const char* what, uint32_t capacity, uint64_t most) {
    if (capacity == 0 || capacity > most) {
        throw Error("the observations' capacity is ", capacity, " ", what, ", it must be 1 to ", most,
                    " on this device");
    }
}

}  // namespace

ObservationMap::ObservationMap(vulkan::Device& device, const ObservationMapSettings& settings)
    : settings_(settings), edge_shift_(edge_shift_of(settings)) {
    const uint64_t range = std::min(device.caps().max_storage_range, settings.max_chunk_bytes);
    const uint32_t chunk_records = static_cast<uint32_t>(std::bit_floor(range) / kQuadBytes);
    const uint32_t table_bytes = 4u << 3 * edge_shift_;
    // A table slot and a voxel's number go into one word, see PixelVoxels.
    check_capacity("blocks", settings.capacity_blocks, std::min<uint64_t>(range / table_bytes, 1u << 23));
    check_capacity("records", settings.capacity_records, uint64_t{chunk_records} * gpu::kMaxVoxelChunks);

    // As VoxelMap's table: sparse, and wide enough for all keys of a frame.
    table_slots_ = std::bit_ceil(std::max(settings.capacity_blocks, 32768u)) * 4;
    grid_.voxel_m = settings.voxel_m;
    grid_.bucket_mask = table_slots_ / gpu::kBucketSlots - 1;
    grid_.capacity = settings.capacity_blocks;
    grid_.chunk_shift = static_cast<uint32_t>(std::countr_zero(chunk_records));

    const auto buffer = [&](const char* name, uint64_t bytes) { return device.create_buffer({name, bytes}); };
    const uint64_t blocks = settings.capacity_blocks, records = settings.capacity_records;
    keys_ = buffer("observations.keys", table_slots_ * 4u);
    blocks_ = buffer("observations.blocks", table_slots_ * 4u);
    new_slots_ = buffer("observations.new_slots", table_slots_ * 4u);
    block_keys_ = buffer("observations.block_keys", blocks * 4);
    block_counters_ = buffer("observations.block_counters", sizeof(gpu::MapCounters));
    record_counters_ = buffer("observations.record_counters", sizeof(gpu::MapCounters));
    block_arguments_ = buffer("observations.block_arguments", 16);
    record_table_ = buffer("observations.record_table", blocks * table_bytes);
    records_ = buffer("observations.records", records * sizeof(gpu::VoxelRecord));
    seen_ = buffer("observations.seen", records * 4);
    changed_ = buffer("observations.changed", records * 4);
    albedo_ = buffer("observations.albedo", records * 8);
    visibility_ = buffer("observations.visibility", records * 8);
    directions_ = {device, "observations.directions", records, kQuadBytes, chunk_records, gpu::kMaxVoxelChunks};
    colors_ = {device, "observations.colors", records, kQuadBytes, chunk_records, gpu::kMaxVoxelChunks};
}

void ObservationMap::reset(graph::Frame& frame, glm::dvec3 center_m) {
    grid_.origin_block = glm::ivec4(glm::ivec3(glm::floor(center_m / double{settings_.block_m})), 0);
    ObservationMapIds ids = import(frame);
    const auto counters = [&](graph::BufferId id, uint32_t capacity) {
        gpu::MapCounters values{};
        values.free_blocks = capacity;
        return frame.upload_bytes(id, 0, std::as_bytes(std::span(&values, 1)), true);
    };
    ids.keys = frame.fill(ids.keys, gpu::kEmptyKey);
    ids.block_arguments = frame.fill(ids.block_arguments, 0);
    ids.block_counters = counters(ids.block_counters, settings_.capacity_blocks);
    ids.record_counters = counters(ids.record_counters, settings_.capacity_records);
    keep(frame, ids);
}

ObservationMapIds ObservationMap::import(graph::Frame& frame) const {
    return {frame.import(keys_),
            frame.import(blocks_),
            frame.import(block_keys_),
            frame.import(new_slots_),
            frame.import(block_counters_),
            frame.import(record_counters_),
            frame.import(block_arguments_),
            frame.import(record_table_),
            frame.import(records_),
            frame.import(seen_),
            frame.import(changed_),
            frame.import(albedo_),
            frame.import(visibility_),
            frame.import(directions_),
            frame.import(colors_)};
}

void ObservationMap::keep(graph::Frame& frame, const ObservationMapIds& ids) {
    for (const graph::BufferId id : {ids.keys, ids.blocks, ids.block_keys, ids.block_counters, ids.record_counters,
                                     ids.block_arguments, ids.record_table, ids.records, ids.seen, ids.changed,
                                     ids.albedo, ids.visibility, ids.directions, ids.colors}) {
        frame.keep(id);
    }
}

std::vector<VoxelMap::PoolBytes> ObservationMap::memory() const {
    return {{"observations", directions_.bytes() + colors_.bytes()},
            {"observed voxels",
             records_->bytes() + seen_->bytes() + changed_->bytes() + albedo_->bytes() + visibility_->bytes()},
            {"observation table",
             keys_->bytes() + blocks_->bytes() + new_slots_->bytes() + block_keys_->bytes() + record_table_->bytes()}};
}

}  // namespace patina
