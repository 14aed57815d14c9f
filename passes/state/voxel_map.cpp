#include "passes/state/voxel_map.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "engine/core/error.h"
#include "passes/state/block_at.h"
#include "passes/state/pool_sizes.h"

namespace patina {

namespace {

constexpr uint32_t kBlockBytes = gpu::kBlockVoxels * 4;  // of distances, and as many of colours

/// Blocks per chunk, a power of two.
uint32_t blocks_per_chunk(const vulkan::DeviceCaps& caps, uint64_t max_chunk_bytes) {
    return static_cast<uint32_t>(std::bit_floor(std::min(caps.max_storage_range, max_chunk_bytes)) / kBlockBytes);
}

}  // namespace

VoxelMap::VoxelMap(vulkan::Device& device, const VoxelMapSettings& settings) : settings_(settings) {
    const uint32_t chunk_blocks = blocks_per_chunk(device.caps(), settings.max_chunk_bytes);
    const uint32_t limit = limit_or_none(settings.limit_blocks);
    const uint32_t capacity = std::min(settings.capacity_blocks, limit);
    most_blocks_ = std::min(chunk_blocks * gpu::kMaxVoxelChunks, limit);
    if (capacity == 0 || capacity > most_blocks_) {
        throw Error("the voxel pool's capacity is ", capacity, " blocks, it must be 1 to ", most_blocks_,
                    " on this device");
    }
    if (!(settings.voxel_m >= 1e-4f && settings.voxel_m <= 1.0f)) {
        throw Error("the voxel size is ", settings.voxel_m, " m, it must be 0.0001 to 1");
    }
    table_slots_ = table_slots_for(capacity);
    grid_.voxel_m = settings.voxel_m;
    grid_.bucket_mask = table_slots_ / gpu::kBucketSlots - 1;
    grid_.capacity = capacity;
    grid_.chunk_shift = static_cast<uint32_t>(std::countr_zero(chunk_blocks));

    const auto buffer = [&](const char* name, uint64_t bytes) { return device.create_buffer({name, bytes}); };
    keys_ = buffer("map.keys", table_slots_ * 4u);
    blocks_ = buffer("map.blocks", table_slots_ * 4u);
    new_slots_ = buffer("map.new_slots", table_slots_ * 4u);
    block_keys_ = buffer("map.block_keys", capacity * 4u);
    free_list_ = buffer("map.free_list", capacity * 4u);
    counters_ = buffer("map.counters", sizeof(gpu::MapCounters));
    assign_arguments_ = buffer("map.assign_arguments", 16);
    block_arguments_ = buffer("map.block_arguments", 16);
    tsdf_ = {device, "map.tsdf", capacity, kBlockBytes, chunk_blocks, gpu::kMaxVoxelChunks};
    color_ = {device, "map.color", capacity, kBlockBytes, chunk_blocks, gpu::kMaxVoxelChunks};
}

void VoxelMap::reset(graph::FrameGraph& frame, glm::dvec3 center_m) {
    grid_.origin_block = glm::ivec4(block_at(center_m / double(settings_.voxel_m * gpu::kBlockEdge)), 0);
    std::vector<uint32_t> stack(capacity());
    std::iota(stack.rbegin(), stack.rend(), 0u);  // popped from the end: 0 first
    gpu::MapCounters counters{};
    counters.free_blocks = counters.capacity = capacity();

    VoxelMapIds ids = import(frame);
    ids.keys = frame.fill(ids.keys, gpu::kEmptyKey);
    ids.block_keys = frame.fill(ids.block_keys, gpu::kEmptyKey);
    ids.block_arguments = frame.fill(ids.block_arguments, 0);
    ids.free_list = frame.upload_bytes(ids.free_list, 0, std::as_bytes(std::span(stack)), true);
    ids.counters = frame.upload_bytes(ids.counters, 0, std::as_bytes(std::span(&counters, 1)), true);
    keep(frame, ids);
}

void VoxelMap::enlarge(graph::Enlargement& enlargement, uint32_t blocks) {
    PATINA_ASSERT(blocks > capacity() && blocks <= most_blocks_, "the voxel pool grows from ", capacity(), " to ",
                  blocks, " blocks, at most ", most_blocks_);
    const uint32_t slots = table_slots_for(blocks);
    const uint64_t added_bytes = (uint64_t{blocks} - capacity()) * sizeof(uint32_t);
    enlargement.add(keys_, slots * 4u, {.kept = false, .fill = gpu::kEmptyKey});
    enlargement.add(blocks_, slots * 4u, {.kept = false});
    enlargement.add(new_slots_, slots * 4u, {.kept = false});
    enlargement.add(block_keys_, blocks * 4u, {.fill = gpu::kEmptyKey});
    // New blocks are popped last: ids in use stay below the high-water mark.
    enlargement.add(free_list_, blocks * 4u, {.offset = added_bytes});
    enlargement.add(tsdf_, blocks);
    enlargement.add(color_, blocks);
    enlargement.set(table_slots_, slots);
    enlargement.set(grid_.bucket_mask, slots / gpu::kBucketSlots - 1);
    enlargement.set(grid_.capacity, blocks);
}

VoxelMapIds VoxelMap::import(graph::FrameGraph& frame) const {
    return {frame.import(keys_),
            frame.import(blocks_),
            frame.import(block_keys_),
            frame.import(free_list_),
            frame.import(new_slots_),
            frame.import(counters_),
            frame.import(assign_arguments_),
            frame.import(block_arguments_),
            frame.import(tsdf_),
            frame.import(color_)};
}

void VoxelMap::keep(graph::FrameGraph& frame, const VoxelMapIds& ids) {
    for (const graph::BufferId id : {ids.keys, ids.blocks, ids.block_keys, ids.free_list, ids.counters,
                                     ids.block_arguments, ids.tsdf, ids.color}) {
        frame.keep(id);
    }
}

std::vector<VoxelMap::PoolBytes> VoxelMap::memory() const {
    return {{"voxel distances", tsdf_.bytes()},
            {"voxel colours", color_.bytes()},
            {"voxel table", keys_->bytes() + blocks_->bytes() + new_slots_->bytes()},
            {"voxel block lists", block_keys_->bytes() + free_list_->bytes()}};
}

void VoxelMap::visit(graph::StateVisitor& visitor) {
    const uint32_t chunk_shift = grid_.chunk_shift;
    visitor.value("map.grid", grid_);
    grid_.chunk_shift = chunk_shift;  // this device's
    visitor.value("map.table_slots", table_slots_);
    for (vulkan::BufferRef* buffer : {&keys_, &blocks_, &block_keys_, &free_list_, &new_slots_, &counters_,
                                      &assign_arguments_, &block_arguments_}) {
        visitor.buffer(*buffer);
    }
    visitor.array(tsdf_);
    visitor.array(color_);
}

}  // namespace patina
