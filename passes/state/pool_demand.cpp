#include "passes/state/pool_demand.h"

#include <algorithm>

namespace patina {

void PoolDemand::note(const PoolCount& count) {
    capacity_ = count.capacity;
    free_ = count.free;
    used_ = count.capacity - count.free;
    refused_last_ = count.refused - refused_;
    greediest_ = std::max(greediest_, count.taken - taken_ + refused_last_);
    taken_ = count.taken;
    refused_ = count.refused;
}

uint32_t PoolDemand::wanted(uint32_t capacity, uint32_t step, uint32_t coming) const {
    // The pool may have grown since the counters were taken.
    const uint64_t grown = capacity - capacity_;
    const uint64_t free = free_ + grown;
    const uint64_t missing = refused_last_ - std::min<uint64_t>(grown, refused_last_);
    const uint64_t needed = uint64_t{greediest_} * kFramesAhead + missing + coming;
    // Labels that are given are refused when they are beyond the capacity, however many are free.
    if (free >= needed && missing == 0) return capacity;
    const uint64_t more = std::max<uint64_t>(std::min(capacity, step), needed - std::min(free, needed));
    return static_cast<uint32_t>(std::min<uint64_t>(capacity + more, UINT32_MAX));
}

}  // namespace patina
