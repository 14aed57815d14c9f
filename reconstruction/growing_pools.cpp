#include "reconstruction/growing_pools.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "engine/core/error.h"
#include "passes/fusion/grow_voxels.h"
#include "passes/observation/grow_observations.h"
#include "passes/segmentation/grow_labels.h"
#include "passes/surface/extract_surface.h"

namespace patina {

namespace {

/// When memory is short, less and less is asked for, down to this part of what was wanted.
constexpr uint32_t kSmallestShare = 16;
/// And where that is in vain, this many frames go by until the next attempt.
constexpr uint32_t kFramesBetweenAttempts = 8;
/// Where things leave the device, their pool grows by this part of what should be there.
constexpr uint32_t kStepsOfResident = 8;

/// By how much a pool grows at most, unless more is asked for; without any that leave, `most`.
uint32_t step_of(uint32_t capacity, uint32_t resident, uint32_t most) {
    const bool many = resident > 0 && capacity >= resident;
    return many ? std::max(resident / kStepsOfResident, 1u) : most;
}

uint32_t sum_of(std::span<const uint32_t> counts) { return std::accumulate(counts.begin(), counts.end(), 0u); }

template <class Counters>
auto counter_of(graph::Readback PoolReadbacks::*read) {
    return [read](const PoolReadbacks& counters) { return count_of((counters.*read).as<Counters>().front()); };
}

}  // namespace

GrowingPools::GrowingPools(vulkan::Device& device, VoxelMap& map, SegmentationStage* segmentation,
                           ReflectanceStage* reflectance, SpecularStage* specular, ResidentPlaces resident)
    : device_(device), resident_(resident) {
    add_voxel_pool(map, segmentation);
    if (reflectance) add_observation_pools(*reflectance);
    if (segmentation) add_label_pool(*segmentation, reflectance, specular);
}

void GrowingPools::add_voxel_pool(VoxelMap& map, SegmentationStage* segmentation) {
    Pool pool{{"voxel blocks", "map.capacity_blocks"}, map.settings().limit_blocks};
    pool.capacity = [&map] { return map.capacity(); };
    pool.most = [&map] { return map.most_blocks(); };
    pool.step = [this, &map] { return step_of(map.capacity(), resident_.voxel_blocks, map.chunk_blocks()); };
    pool.enlarge = [&map, segmentation](graph::Enlargement& enlargement, uint32_t blocks) {
        map.enlarge(enlargement, blocks);
        if (segmentation) segmentation->enlarge_blocks(enlargement, blocks);
    };
    pool.add_grow = [&map](graph::FrameGraph& frame, uint32_t before) {
        VoxelMapIds ids = map.import(frame);
        add_grow_voxels(frame, map, ids, before);
    };
    pool.keep = [&map](graph::FrameGraph& frame) { VoxelMap::keep(frame, map.import(frame)); };
    pool.reserve = kSurfaceBlockBytes;
    pool.count = counter_of<gpu::MapCounters>(&PoolReadbacks::voxels);
    pools_.push_back(std::move(pool));
}

void GrowingPools::add_observation_pools(ReflectanceStage& reflectance) {
    const ObservationMap& map = reflectance.observations();
    const auto add = [&](PoolState state, uint32_t limit, graph::Readback PoolReadbacks::*counters, auto add_grow) {
        Pool& pool = pools_.emplace_back(Pool{state, limit});
        pool.add_grow = [&map, add_grow](graph::FrameGraph& frame, uint32_t before) {
            ObservationMapIds ids = map.import(frame);
            add_grow(frame, map, ids, before);
        };
        pool.keep = [&map](graph::FrameGraph& frame) { ObservationMap::keep(frame, map.import(frame)); };
        pool.count = counter_of<gpu::MapCounters>(counters);
        return &pool;
    };
    Pool* pool = add({"observed blocks", "reflectance.capacity_blocks"}, map.settings().limit_blocks,
                     &PoolReadbacks::observed_blocks, add_grow_observed_blocks);
    pool->capacity = pool->step = [&map] { return map.capacity_blocks(); };
    pool->most = [&map] { return map.most_blocks(); };
    pool->enlarge = [&reflectance](graph::Enlargement& enlargement, uint32_t count) {
        reflectance.enlarge_blocks(enlargement, count);
    };
    pool = add({"observed voxels", "reflectance.capacity_records"}, map.settings().limit_records,
               &PoolReadbacks::observed_records, add_grow_records);
    pool->capacity = [&map] { return map.capacity_records(); };
    pool->most = [&map] { return map.most_records(); };
    pool->step = [this, &map] {
        return step_of(map.capacity_records(), resident_.observed_records, map.chunk_records());
    };
    pool->enlarge = [&reflectance](graph::Enlargement& enlargement, uint32_t count) {
        reflectance.enlarge_records(enlargement, count);
    };
}

void GrowingPools::add_label_pool(SegmentationStage& segmentation, ReflectanceStage* reflectance,
                                  SpecularStage* specular) {
    Pool pool{{"labels", "segmentation.capacity_labels"}, segmentation.settings().limit_labels};
    const SegmentTable& table = segmentation.table();
    pool.capacity = [&table] { return table.capacity(); };
    const uint32_t most_fits = specular ? WardFits::most_labels(device_.caps()) : UINT32_MAX;
    pool.most = [&segmentation, most_fits] { return std::min(segmentation.most_labels(), most_fits); };
    pool.step = pool.capacity;
    pool.enlarge = [&segmentation, reflectance, specular](graph::Enlargement& enlargement, uint32_t labels) {
        segmentation.enlarge_labels(enlargement, labels);
        if (reflectance) reflectance->enlarge_labels(enlargement, labels);
        if (specular) specular->enlarge_labels(enlargement, labels);
    };
    pool.add_grow = [&table](graph::FrameGraph& frame, uint32_t before) {
        SegmentTableIds ids = table.import(frame);
        add_grow_labels(frame, table, ids, before);
    };
    pool.keep = [&table](graph::FrameGraph& frame) { SegmentTable::keep(frame, table.import(frame)); };
    pool.count = counter_of<gpu::SegmentCounters>(&PoolReadbacks::labels);
    pools_.push_back(std::move(pool));
}

void GrowingPools::reset() {
    pending_.clear();
    for (Pool& pool : pools_) {
        pool.demand = {};
        pool.grown_at = pool.try_at = pool.came_again = 0;
        pool.coming = {};
    }
}

void GrowingPools::await(uint32_t index, const PoolReadbacks& counters) { pending_.push_back({index, counters}); }

std::vector<PoolCount> GrowingPools::counts_of(const Pending& pending) const {
    if (!pending.counts.empty()) return pending.counts;
    std::vector<PoolCount> counts;
    for (const Pool& pool : pools_) counts.push_back(pool.count(pending.counters));
    return counts;
}

void GrowingPools::note(Pool& pool, uint32_t frame, const PoolCount& count) {
    pool.demand.note(count);
    if (frame < pool.grown_at) pool.came_again = pool.demand.refused();
}

void GrowingPools::note_until(uint32_t frame) {
    for (; !pending_.empty() && pending_.front().frame <= frame; pending_.pop_front()) {
        const std::vector<PoolCount> counts = counts_of(pending_.front());
        for (size_t i = 0; i < pools_.size(); ++i) note(pools_[i], pending_.front().frame, counts[i]);
    }
}

bool GrowingPools::first_was_refused() {
    note_until(0);
    return std::any_of(pools_.begin(), pools_.end(), [](const Pool& pool) { return pool.demand.refused() > 0; });
}

/// What the host may know before frame `index`.
void GrowingPools::note_before(uint32_t index) {
    note_until(std::max(index, PoolDemand::kFramesAhead) - PoolDemand::kFramesAhead);
}

bool GrowingPools::has_many(const Pool& pool, uint32_t resident) {
    return resident > 0 && (pool.demand.used() > resident || pool.state.limit != PoolLimit::kNone);
}

bool GrowingPools::has_many_blocks(uint32_t index) {
    note_before(index);
    return has_many(pools_.front(), resident_.voxel_blocks);
}

bool GrowingPools::has_many_records(uint32_t index) {
    note_before(index);
    const Pool &blocks = pools_.at(1), &records = pools_.at(2);
    // A record takes a block at most.
    return has_many(records, resident_.observed_records) || has_many(blocks, resident_.observed_records);
}

bool GrowingPools::grow(graph::Runner& runner, uint32_t index, ComingPlaces coming) {
    graph::FrameGraph frame = runner.begin();  // waits for frame `index` - 2
    note_before(index);
    const std::array places{coming.voxel_blocks, coming.observed_blocks, coming.observed_records};
    for (size_t i = 0; i < std::min(places.size(), pools_.size()); ++i) {
        std::rotate(pools_[i].coming.begin(), pools_[i].coming.end() - 1, pools_[i].coming.end());
        // Without reflectance, the next pool is that of labels, and nothing of those comes back.
        pools_[i].coming.front() = places[i];
    }
    std::vector<graph::Enlargement> committed;
    std::vector<Pool*> grown;
    for (Pool& pool : pools_) {
        const uint32_t before = pool.capacity();
        auto enlargement = grow(frame, pool, index);
        if (!enlargement) continue;
        committed.push_back(*std::move(enlargement));
        grown.push_back(&pool);
        pool.add_grow(frame, before);
    }
    if (grown.empty()) return false;
    // Two pools may share a buffer: what is kept is the last version.
    for (const Pool* pool : grown) pool->keep(frame);
    for (const graph::Enlargement& enlargement : committed) enlargement.keep(frame);
    runner.submit(std::move(frame));
    for (graph::Enlargement& enlargement : committed) enlargement.accept();
    for (Pool* pool : grown) {
        ++pool->state.growths;
        pool->grown_at = index;
    }
    runner.forget_shapes();
    return true;
}

std::optional<graph::Enlargement> GrowingPools::grow(graph::FrameGraph& frame, Pool& pool, uint32_t index) {
    const uint32_t capacity = pool.capacity(), most = pool.most();
    const uint64_t wanted = pool.demand.wanted(capacity, pool.step(), sum_of(pool.coming));
    if (wanted > most) pool.state.limit = most == pool.limit_setting ? PoolLimit::kSetting : PoolLimit::kBuffers;
    const auto target = static_cast<uint32_t>(std::min<uint64_t>(wanted, most));
    if (target == capacity || index < pool.try_at) return std::nullopt;
    for (uint32_t share = 1; share <= std::min(kSmallestShare, target - capacity); share *= 2) {
        if (auto enlargement = try_capacity(frame, pool, capacity + (target - capacity) / share)) {
            if (pool.state.limit == PoolLimit::kMemory) pool.state.limit = PoolLimit::kNone;
            return enlargement;
        }
    }
    // Frames in flight, and the old buffers of a pool that grew, give theirs back.
    pool.state.limit = PoolLimit::kMemory;
    pool.try_at = index + kFramesBetweenAttempts;
    return std::nullopt;
}

std::optional<graph::Enlargement> GrowingPools::try_capacity(graph::FrameGraph& frame, const Pool& pool,
                                                             uint32_t capacity) {
    graph::Enlargement enlargement(device_);
    pool.enlarge(enlargement, capacity);
    if (enlargement.bytes() + pool.reserve * capacity > device_.available_memory()) return std::nullopt;
    try {
        enlargement.allocate();
    } catch (const vulkan::OutOfMemory&) {
        return std::nullopt;
    }
    enlargement.commit(frame);
    return enlargement;
}

std::vector<PoolState> GrowingPools::states() const {
    std::vector<Pool> pools = pools_;
    for (const Pending& pending : pending_) {
        if (!pending.ready()) continue;
        const std::vector<PoolCount> counts = counts_of(pending);
        for (size_t i = 0; i < pools.size(); ++i) note(pools[i], pending.frame, counts[i]);
    }
    std::vector<PoolState> states;
    for (const Pool& pool : pools) {
        PoolState& state = states.emplace_back(pool.state);
        state.capacity = pool.capacity();
        state.used = pool.demand.used();
        state.refused = pool.demand.refused() - pool.came_again;
    }
    return states;
}

void GrowingPools::visit(graph::StateVisitor& visitor) {
    std::vector<uint32_t> frames;
    std::vector<PoolCount> counts;  // by frame and pool
    for (const Pending& pending : pending_) {
        frames.push_back(pending.frame);
        for (const PoolCount& count : counts_of(pending)) counts.push_back(count);
    }
    visitor.values("pools.pending_frames", frames);
    visitor.values("pools.pending_counts", counts);
    if (counts.size() != frames.size() * pools_.size())
        throw Error("'pools.pending_counts' has ", counts.size(), " counts, not those of ", pools_.size(), " pools in ",
                    frames.size(), " frames");
    pending_.clear();
    for (size_t i = 0; i < frames.size(); ++i) {
        const auto first = counts.begin() + static_cast<std::ptrdiff_t>(i * pools_.size());
        pending_.push_back({frames[i], {}, {first, first + static_cast<std::ptrdiff_t>(pools_.size())}});
    }
    for (Pool& pool : pools_) {
        const std::string name = text("pools.", pool.state.name);
        visitor.value(name + ".demand", pool.demand);
        visitor.value(name + ".growths", pool.state.growths);
        visitor.value(name + ".limit", pool.state.limit);
        visitor.value(name + ".grown_at", pool.grown_at);
        visitor.value(name + ".try_at", pool.try_at);
        visitor.value(name + ".came_again", pool.came_again);
        visitor.value(name + ".coming", pool.coming);
    }
}

}  // namespace patina
