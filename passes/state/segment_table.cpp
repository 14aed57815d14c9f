#include "passes/state/segment_table.h"

#include <numeric>
#include <vector>

#include "engine/core/error.h"

namespace patina {

SegmentTable::SegmentTable(vulkan::Device& device, uint32_t capacity) : capacity_(capacity) {
    if (capacity < 2 || capacity > kMaxCapacity)
        throw Error("the segment table's capacity is ", capacity, " labels, it must be 2 to ", kMaxCapacity);
    const auto buffer = [&](const char* name, uint64_t bytes) { return device.create_buffer({name, bytes}); };
    parents_ = buffer("segments.parents", capacity * sizeof(uint32_t));
    partners_ = buffer("segments.partners", capacity * sizeof(uint32_t));
    rules_ = buffer("segments.split_rules", capacity * sizeof(gpu::SplitRule));
    labels_ = buffer("segments.labels", capacity * sizeof(gpu::SegmentLabel));
    pairs_ = buffer("segments.pairs", gpu::kPairBuckets * gpu::kPairWays * sizeof(gpu::SegmentPair));
    free_labels_ = buffer("segments.free_labels", capacity * sizeof(uint32_t));
    counters_ = buffer("segments.counters", sizeof(gpu::SegmentCounters));
}

void SegmentTable::reset(graph::FrameGraph& frame) const {
    std::vector<uint32_t> free_labels(capacity_);
    std::iota(free_labels.begin(), free_labels.end(), 1u);  // the last one is never reached
    gpu::SegmentCounters counters{};
    counters.high_water = 1;
    counters.free_labels = capacity_ - 1;
    counters.capacity = capacity_;
    SegmentTableIds ids = import(frame);
    ids.parents = frame.fill(ids.parents, 0);
    ids.partners = frame.fill(ids.partners, 0);
    ids.rules = frame.fill(ids.rules, 0);
    ids.labels = frame.fill(ids.labels, 0);
    ids.pairs = frame.fill(ids.pairs, 0);
    ids.free_labels = frame.upload_bytes(ids.free_labels, 0, std::as_bytes(std::span(free_labels)), true);
    ids.counters = frame.upload_bytes(ids.counters, 0, std::as_bytes(std::span(&counters, 1)), true);
    keep(frame, ids);
}

void SegmentTable::enlarge(graph::Enlargement& enlargement, uint32_t capacity) {
    PATINA_ASSERT(capacity > capacity_ && capacity <= kMaxCapacity, "the segment table grows from ", capacity_, " to ",
                  capacity, " labels, at most ", kMaxCapacity);
    enlargement.add(parents_, capacity * sizeof(uint32_t), {.fill = 0});
    enlargement.add(partners_, capacity * sizeof(uint32_t), {.fill = 0});
    enlargement.add(rules_, capacity * sizeof(gpu::SplitRule), {.fill = 0});
    enlargement.add(labels_, capacity * sizeof(gpu::SegmentLabel), {.fill = 0});
    enlargement.add(free_labels_, capacity * sizeof(uint32_t));
    enlargement.set(capacity_, capacity);
}

SegmentTableIds SegmentTable::import(graph::FrameGraph& frame) const {
    return {frame.import(parents_), frame.import(partners_),    frame.import(rules_),   frame.import(labels_),
            frame.import(pairs_),   frame.import(free_labels_), frame.import(counters_)};
}

void SegmentTable::keep(graph::FrameGraph& frame, const SegmentTableIds& ids) {
    for (const graph::BufferId id :
         {ids.parents, ids.partners, ids.rules, ids.labels, ids.pairs, ids.free_labels, ids.counters})
        frame.keep(id);
}

uint64_t SegmentTable::bytes() const {
    return parents_->bytes() + partners_->bytes() + rules_->bytes() + labels_->bytes() + pairs_->bytes() +
           free_labels_->bytes() + counters_->bytes();
}

void SegmentTable::visit(graph::StateVisitor& visitor) {
    visitor.value("segments.capacity", capacity_);
    for (vulkan::BufferRef* buffer : {&parents_, &partners_, &rules_, &labels_, &pairs_, &free_labels_, &counters_})
        visitor.buffer(*buffer);
}

}  // namespace patina
