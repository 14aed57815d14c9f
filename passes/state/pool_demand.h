#pragma once

#include <cstdint>

#include "shared/fusion/voxel_map.h"
#include "shared/segmentation/segments.h"

namespace patina {

/// What a pool counts, as of a frame's end.
struct PoolCount {
    uint32_t capacity = 0, free = 0;
    uint32_t taken = 0;    ///< places over the whole run, those that were given back too
    uint32_t refused = 0;  ///< requests over the whole run
};

inline PoolCount count_of(const gpu::MapCounters& c) {
    // What left and came back was not asked for anew.
    const uint32_t given_back = c.deleted_blocks + c.left_blocks - c.returned_blocks;
    return {c.capacity, c.free_blocks, c.capacity - c.free_blocks + given_back, c.refused_blocks};
}
inline PoolCount count_of(const gpu::SegmentCounters& c) { return {c.capacity, c.free_labels, c.created, c.refused}; }

/// Decides when a pool grows and how far, from its counters alone. The host knows a frame's counters two frames later,
/// so that a pool should always have room for two frames as greedy as the greediest so far.
class PoolDemand {
  public:
    static constexpr uint32_t kFramesAhead = 2;

    /// Each frame's once, in order.
    void note(const PoolCount& count);

    /// The capacity that a pool of `capacity` places should have by now: `capacity` itself where there is room, else
    /// twice that, but no more than `step` above, unless more was asked for.
    /// `coming`: places that will be taken besides.
    uint32_t wanted(uint32_t capacity, uint32_t step, uint32_t coming = 0) const;

    uint32_t used() const { return used_; }        ///< places in use, as of the last counters
    uint32_t refused() const { return refused_; }  ///< requests so far that found the pool full

  private:
    uint32_t capacity_ = 0, free_ = 0, used_ = 0, taken_ = 0, refused_ = 0;
    uint32_t refused_last_ = 0;  ///< in the last frame
    uint32_t greediest_ = 0;     ///< the most places that one frame asked for
};

}  // namespace patina
