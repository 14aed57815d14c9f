#include "passes/state/observation_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "engine/core/error.h"
#include "passes/state/block_at.h"
#include "passes/state/pool_sizes.h"
#include "shared/reflectance/reflectance.h"

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

uint32_t checked_capacity(const char* what, uint32_t capacity, uint32_t most) {
    if (capacity == 0 || capacity > most) {
        throw Error("the observations' capacity is ", capacity, " ", what, ", it must be 1 to ", most,
                    " on this device");
    }
    return capacity;
}

/// Uploads a stack of `count` ids, popped from its end: 0 first.
graph::BufferId all_free(graph::FrameGraph& frame, graph::BufferId stack, uint32_t count) {
    std::vector<uint32_t> ids(count);
    std::iota(ids.rbegin(), ids.rend(), 0u);
    return frame.upload_bytes(stack, 0, std::as_bytes(std::span(ids)), true);
}

/// Announces a longer stack of free ids. New ids are popped last: ids in use stay below the high-water mark.
void enlarge_stack(graph::Enlargement& enlargement, vulkan::BufferRef& stack, uint32_t before, uint32_t count) {
    enlargement.add(stack, count * uint64_t{4}, {.offset = (uint64_t{count} - before) * 4});
}

}  // namespace

ObservationMap::ObservationMap(vulkan::Device& device, const ObservationMapSettings& settings)
    : settings_(settings), edge_shift_(edge_shift_of(settings)) {
    const uint64_t range = std::min(device.caps().max_storage_range, settings.max_chunk_bytes);
    const uint32_t chunk_records = static_cast<uint32_t>(std::bit_floor(range) / kQuadBytes);
    const uint32_t table_bytes = 4u << 3 * edge_shift_;
    // A table slot and a voxel's number go into one word, see PixelVoxels; and passes over all slots, four a block, are
    // one row of groups.
    const uint32_t most_tables = static_cast<uint32_t>(std::min<uint64_t>(range / table_bytes, 1u << 19));
    // The arrays by record that are one buffer each; and passes over all records are one row of groups.
    const uint64_t most_in_one = std::min<uint64_t>(range / sizeof(gpu::RecordStatus), 65535u * gpu::kRecordGroup);
    const uint64_t most_in_chunks = uint64_t{chunk_records} * gpu::kMaxVoxelChunks;
    const uint32_t limit_blocks = limit_or_none(settings.limit_blocks);
    const uint32_t limit_records = limit_or_none(settings.limit_records);
    most_blocks_ = std::min(most_tables, limit_blocks);
    most_records_ = std::min(static_cast<uint32_t>(std::min(most_in_one, most_in_chunks)), limit_records);
    const uint32_t first_blocks =
        checked_capacity("blocks", std::min(settings.capacity_blocks, limit_blocks), most_blocks_);
    capacity_records_ = checked_capacity("records", std::min(settings.capacity_records, limit_records), most_records_);

    table_slots_ = table_slots_for(first_blocks);
    grid_.voxel_m = settings.voxel_m;
    grid_.bucket_mask = table_slots_ / gpu::kBucketSlots - 1;
    grid_.capacity = first_blocks;
    grid_.chunk_shift = static_cast<uint32_t>(std::countr_zero(chunk_records));

    const auto buffer = [&](const char* name, uint64_t bytes) { return device.create_buffer({name, bytes}); };
    const uint64_t blocks = first_blocks, records = capacity_records_;
    keys_ = buffer("observations.keys", table_slots_ * 4u);
    blocks_ = buffer("observations.blocks", table_slots_ * 4u);
    new_slots_ = buffer("observations.new_slots", table_slots_ * 4u);
    block_keys_ = buffer("observations.block_keys", blocks * 4);
    free_blocks_ = buffer("observations.free_blocks", blocks * 4);
    free_records_ = buffer("observations.free_records", records * 4);
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

void ObservationMap::reset(graph::FrameGraph& frame, glm::dvec3 center_m) {
    grid_.origin_block = glm::ivec4(block_at(center_m / double{settings_.block_m}), 0);
    ObservationMapIds ids = import(frame);
    const auto counters = [&](graph::BufferId id, uint32_t capacity) {
        gpu::MapCounters values{};
        values.free_blocks = values.capacity = capacity;
        return frame.upload_bytes(id, 0, std::as_bytes(std::span(&values, 1)), true);
    };
    ids.keys = frame.fill(ids.keys, gpu::kEmptyKey);
    ids.block_keys = frame.fill(ids.block_keys, gpu::kEmptyKey);
    ids.free_blocks = all_free(frame, ids.free_blocks, capacity_blocks());
    ids.free_records = all_free(frame, ids.free_records, capacity_records_);
    ids.block_arguments = frame.fill(ids.block_arguments, 0);
    ids.block_counters = counters(ids.block_counters, capacity_blocks());
    ids.record_counters = counters(ids.record_counters, capacity_records_);
    keep(frame, ids);
}

void ObservationMap::enlarge_blocks(graph::Enlargement& enlargement, uint32_t blocks) {
    PATINA_ASSERT(blocks > capacity_blocks() && blocks <= most_blocks_, "the pool of observed blocks grows from ",
                  capacity_blocks(), " to ", blocks, ", at most ", most_blocks_);
    const uint32_t slots = table_slots_for(blocks);
    enlargement.add(keys_, slots * 4u, {.kept = false, .fill = gpu::kEmptyKey});
    enlargement.add(blocks_, slots * 4u, {.kept = false});
    enlargement.add(new_slots_, slots * 4u, {.kept = false});
    enlargement.add(block_keys_, blocks * uint64_t{4}, {.fill = gpu::kEmptyKey});
    enlarge_stack(enlargement, free_blocks_, capacity_blocks(), blocks);
    enlargement.add(record_table_, blocks * (uint64_t{4} << 3 * edge_shift_));
    enlargement.set(table_slots_, slots);
    enlargement.set(grid_.bucket_mask, slots / gpu::kBucketSlots - 1);
    enlargement.set(grid_.capacity, blocks);
}

void ObservationMap::enlarge_records(graph::Enlargement& enlargement, uint32_t records) {
    PATINA_ASSERT(records > capacity_records_ && records <= most_records_, "the pool of observed voxels grows from ",
                  capacity_records_, " to ", records, ", at most ", most_records_);
    enlargement.add(records_, records * sizeof(gpu::VoxelRecord));
    enlarge_stack(enlargement, free_records_, capacity_records_, records);
    for (vulkan::BufferRef* words : {&seen_, &changed_}) enlargement.add(*words, records * uint64_t{4});
    for (vulkan::BufferRef* pairs : {&albedo_, &visibility_}) enlargement.add(*pairs, records * uint64_t{8});
    enlargement.add(directions_, records);
    enlargement.add(colors_, records);
    enlargement.set(capacity_records_, records);
}

ObservationMapIds ObservationMap::import(graph::FrameGraph& frame) const {
    return {frame.import(keys_),           frame.import(blocks_),          frame.import(block_keys_),
            frame.import(free_blocks_),    frame.import(free_records_),    frame.import(new_slots_),
            frame.import(block_counters_), frame.import(record_counters_), frame.import(block_arguments_),
            frame.import(record_table_),   frame.import(records_),         frame.import(seen_),
            frame.import(changed_),        frame.import(albedo_),          frame.import(visibility_),
            frame.import(directions_),     frame.import(colors_)};
}

void ObservationMap::keep(graph::FrameGraph& frame, const ObservationMapIds& ids) {
    for (const graph::BufferId id :
         {ids.keys, ids.blocks, ids.block_keys, ids.free_blocks, ids.free_records, ids.block_counters,
          ids.record_counters, ids.block_arguments, ids.record_table, ids.records, ids.seen, ids.changed, ids.albedo,
          ids.visibility, ids.directions, ids.colors}) {
        frame.keep(id);
    }
}

std::vector<VoxelMap::PoolBytes> ObservationMap::memory() const {
    return {{"observations", directions_.bytes() + colors_.bytes()},
            {"observed voxels", records_->bytes() + seen_->bytes() + changed_->bytes() + albedo_->bytes() +
                                    visibility_->bytes() + free_records_->bytes()},
            {"observation table", keys_->bytes() + blocks_->bytes() + new_slots_->bytes() + block_keys_->bytes() +
                                      free_blocks_->bytes() + record_table_->bytes()}};
}

void ObservationMap::visit(graph::StateVisitor& visitor) {
    const uint32_t chunk_shift = grid_.chunk_shift;
    visitor.value("observations.grid", grid_);
    grid_.chunk_shift = chunk_shift;  // this device's
    visitor.value("observations.table_slots", table_slots_);
    visitor.value("observations.capacity_records", capacity_records_);
    for (vulkan::BufferRef* buffer :
         {&keys_, &blocks_, &block_keys_, &free_blocks_, &free_records_, &new_slots_, &block_counters_,
          &record_counters_, &block_arguments_, &record_table_, &records_, &seen_, &changed_, &albedo_, &visibility_}) {
        visitor.buffer(*buffer);
    }
    visitor.array(directions_);
    visitor.array(colors_);
}

}  // namespace patina
