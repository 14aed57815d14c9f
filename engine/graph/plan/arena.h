#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/graph/plan/plan.h"

namespace patina::graph {

/// A transient resource that wants a place in an arena.
struct ArenaRequest {
    MemoryNeed need;  ///< at least one byte, alignment at least 1
    Lifetime lifetime;
};

/// Where each request lies, in the order of the requests, and what the whole arena needs.
struct ArenaLayout {
    std::vector<Placement> placements;
    MemoryNeed total;
};

/// Places the requests, largest first, each at the lowest aligned offset where it overlaps no placed request that lives
/// at the same time. Requests whose lifetimes do not overlap may share memory. Deterministic: ties go to the earlier
/// first use, then to the earlier request.
ArenaLayout lay_out_arena(std::span<const ArenaRequest> requests);

/// Which resource used each byte of an arena last, as a frame goes on.
class ArenaOccupancy {
  public:
    /// Hands the bytes of `placement` to `resource`; returns the resources that held any of them before, each once.
    std::vector<uint32_t> claim(const Placement& placement, uint32_t resource);

  private:
    struct Segment {
        uint64_t begin = 0;
        uint64_t end = 0;
        uint32_t resource = 0;
    };
    std::vector<Segment> segments_;  ///< disjoint, in no particular order
};

}  // namespace patina::graph
