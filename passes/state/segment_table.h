#pragma once

#include <cstdint>

#include "engine/graph/enlargement.h"
#include "engine/graph/frame_graph.h"
#include "engine/graph/state_visitor.h"
#include "engine/vulkan/device.h"
#include "shared/segmentation/segments.h"

namespace patina {

/// Versions of the table's buffers within one frame.
struct SegmentTableIds {
    graph::BufferId parents;   ///< u32 per label: the label it was merged into, itself while it is in use, 0 if not
    graph::BufferId partners;  ///< u32 per label: that whose colours were its own until it was split; itself: that was
                               ///< in vain, it is not split again; 0: none
    graph::BufferId rules;     ///< gpu::SplitRule per label that has a partner other than itself
    graph::BufferId labels;    ///< gpu::SegmentLabel per label
    graph::BufferId pairs;     ///< gpu::SegmentPair[gpu::kPairBuckets * gpu::kPairWays]
    graph::BufferId free_labels;  ///< u32 ring of the labels not in use
    graph::BufferId counters;     ///< gpu::SegmentCounters
};

/// The segments of the map by label, 1 to capacity() - 1. Labels that are one object's are joined by a union-find whose
/// label that covers more wins; parents point to the root, as they are compressed in every frame. What reads a label
/// takes its root. A label is handed out again only after a whole sweep of the map has found nothing that holds it, and
/// the one that was free for the longest time comes first. Lives as long as the voxel map; passes/segmentation fills
/// it.
class SegmentTable {
  public:
    static constexpr uint32_t kMaxCapacity = 65535;  ///< label 0 and 65534 others

    /// Throws Error when the capacity is below 2 or above kMaxCapacity, or memory runs out.
    SegmentTable(vulkan::Device& device, uint32_t capacity);

    /// Forgets all segments; the first thing done with it.
    void reset(graph::FrameGraph& frame) const;

    /// Announces that there will be `capacity` labels, more than now and at most kMaxCapacity; in the same frame
    /// segmentation/grow_labels.h makes use of them.
    void enlarge(graph::Enlargement& enlargement, uint32_t capacity);

    SegmentTableIds import(graph::FrameGraph& frame) const;
    static void keep(graph::FrameGraph& frame, const SegmentTableIds& ids);

    void visit(graph::StateVisitor& visitor);

    uint32_t capacity() const { return capacity_; }
    uint64_t bytes() const;

  private:
    uint32_t capacity_;
    vulkan::BufferRef parents_, partners_, rules_, labels_, pairs_, free_labels_, counters_;
};

}  // namespace patina
