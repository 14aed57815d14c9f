#include "engine/graph/plan/arena.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace patina::graph {
namespace {

bool overlap(const Lifetime& a, const Lifetime& b) { return a.first <= b.last && b.first <= a.last; }

uint64_t align_up(uint64_t value, uint64_t alignment) { return (value + alignment - 1) / alignment * alignment; }

uint64_t end_of(const Placement& placement) { return placement.offset + placement.bytes; }

std::vector<uint32_t> largest_first(std::span<const ArenaRequest> requests) {
    std::vector<uint32_t> order(requests.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, [&](uint32_t a, uint32_t b) {
        return std::tuple(requests[b].need.bytes, requests[a].lifetime.first, a) <
               std::tuple(requests[a].need.bytes, requests[b].lifetime.first, b);
    });
    return order;
}

/// The lowest aligned offset with room for `need` between `taken`, which is sorted by offset.
uint64_t first_fit(const MemoryNeed& need, const std::vector<Placement>& taken) {
    uint64_t offset = 0;
    for (const Placement& other : taken) {
        if (offset + need.bytes <= other.offset) break;
        offset = std::max(offset, align_up(end_of(other), need.alignment));
    }
    return offset;
}

}  // namespace

ArenaLayout lay_out_arena(std::span<const ArenaRequest> requests) {
    ArenaLayout layout{std::vector<Placement>(requests.size()), {}};
    std::vector<uint32_t> placed;  // sorted by offset
    std::vector<Placement> taken;
    for (uint32_t index : largest_first(requests)) {
        const ArenaRequest& request = requests[index];
        taken.clear();
        for (uint32_t other : placed) {
            if (overlap(request.lifetime, requests[other].lifetime)) taken.push_back(layout.placements[other]);
        }
        const Placement placement{first_fit(request.need, taken), request.need.bytes};
        layout.placements[index] = placement;
        const auto offset_of = [&](uint32_t other) { return layout.placements[other].offset; };
        placed.insert(std::ranges::upper_bound(placed, placement.offset, {}, offset_of), index);
        layout.total.bytes = std::max(layout.total.bytes, end_of(placement));
        layout.total.alignment = std::max(layout.total.alignment, request.need.alignment);
    }
    return layout;
}

std::vector<uint32_t> ArenaOccupancy::claim(const Placement& placement, uint32_t resource) {
    const Segment claimed{placement.offset, end_of(placement), resource};
    std::vector<uint32_t> displaced;
    std::vector<Segment> remaining{claimed};
    for (const Segment& segment : segments_) {
        const bool touched = segment.begin < claimed.end && claimed.begin < segment.end;
        if (!touched) {
            remaining.push_back(segment);
            continue;
        }
        if (std::ranges::find(displaced, segment.resource) == displaced.end()) displaced.push_back(segment.resource);
        if (segment.begin < claimed.begin) remaining.push_back({segment.begin, claimed.begin, segment.resource});
        if (claimed.end < segment.end) remaining.push_back({claimed.end, segment.end, segment.resource});
    }
    segments_ = std::move(remaining);
    return displaced;
}

}  // namespace patina::graph
