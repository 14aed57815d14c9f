#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <variant>
#include <vector>

#include "engine/graph/runner.h"
#include "engine/graph/state_visitor.h"
#include "passes/fusion/stream_blocks.h"
#include "reconstruction/stages/stages.h"
#include "reconstruction/streaming/block_store.h"
#include "reconstruction/streaming/stream_region.h"

namespace patina {

/// How many voxel blocks are where.
struct StreamCounts {
    uint32_t away = 0;      ///< blocks that the device does not have
    uint64_t left = 0;      ///< over the whole run
    uint64_t returned = 0;  ///< over the whole run
    uint64_t awaited = 0;   ///< of these, blocks that a frame had to wait for, as they had not come back ahead of it
    uint64_t filed = 0;     ///< blocks that went to the temporary file, since the run began or went on
};

/// Takes voxel blocks that are far from the camera off the device while many are in use, and brings them back before a
/// frame looks at them: every block of the region that its passes look at is on the device, unless the pool is full. So
/// nothing that a frame computes depends on what is away. Which blocks leave follows poses, frame numbers and keys.
///
/// The labels of blocks that are away take part in the sweeps over all labels, as if they were on the device: a sweep
/// counts them, and its replacement of labels reaches them when the device has finished the frame. For that, blocks
/// leave in frames after which the host knows them by the next sweep.
class Streaming {
  public:
    /// Both must outlive this.
    Streaming(graph::Runner& runner, Stages& stages);

    /// Nothing is away; whenever the map is reset.
    void reset();

    /// Decides what leaves and returns with frame `index`, whose passes look at blocks of `near`; `many`: more blocks
    /// are in use than should be. The frame before the last has finished. Returns how many blocks come back.
    uint32_t plan(const StreamRegion& near, uint32_t index, bool many);
    /// Moves what is more than one frame takes along, in graphs of its own.
    void move_surplus();
    /// Adds to the frame what was planned; before its other passes, which keep the maps.
    void add(graph::FrameGraph& graph);
    /// FrameContext::labels_away of frame `index`; until the next call.
    std::span<const uint32_t> labels_away(uint32_t index);
    /// Takes note of what the frame's sweep replaces labels by; after its passes.
    void await_sweep(graph::FrameGraph& graph, uint32_t index);
    /// The frame's graph was submitted. Without this call, nothing of it has happened.
    void note_submitted();

    /// Between frames: brings the blocks of a region back, and takes others away where their places are needed. Waits.
    void require(const StreamRegion& region);

    /// The coordinates of all blocks of the map, wherever they are. Waits.
    std::vector<glm::ivec3> blocks();

    /// As far as the device has finished.
    bool any_away();
    /// As far as the device has finished.
    StreamCounts counts();
    /// A sentence where memory holds more than it should; else empty.
    std::string problem() const;

    /// The device must have finished.
    void visit(graph::StateVisitor& visitor);

  private:
    struct Leaving {
        glm::dvec3 center_m, axis;  ///< of the region outside of which they lay
        graph::Readback counts, count, blocks, tsdf, color, labels;
    };
    struct Returning {
        std::vector<std::pair<uint32_t, BlockStore::Kept>> kept;  ///< until the device has them
        graph::Readback blocks;
    };
    struct Swept {
        uint32_t part;
        graph::Readback parents;
    };
    using Event = std::variant<Leaving, Returning, Swept>;

    const VoxelMap& map() const { return stages_.geometry.map(); }
    void collect();
    void collect_all();
    void submit(graph::FrameGraph graph);
    void roll_back();
    void note(const Leaving& leaving);
    void note(Returning& returning);
    void note(const Swept& swept);
    template <class Kind>
    bool pends() const;
    bool would_miss(const StreamRegion& near) const;
    graph::Readback add_leaving(graph::FrameGraph& graph, const StreamRegion& region);
    void add_returning(graph::FrameGraph& graph, std::span<const uint32_t> keys);
    void make_room(const StreamRegion& region, size_t blocks);
    std::vector<uint32_t> keys_on_device();

    graph::Runner& runner_;
    Stages& stages_;
    BlockStore store_;
    std::vector<Event> declared_;        ///< of a graph that is not submitted yet
    std::deque<Event> pending_;          ///< of graphs that the device may work on
    std::vector<uint32_t> coming_;       ///< keys that come back with the next frame, those that it needs first
    std::optional<StreamRegion> keeps_;  ///< outside of which blocks leave with the next frame
    uint32_t left_outside_ = 0;          ///< blocks that had to stay when some left last: there were too many
    std::vector<uint32_t> labels_away_;
    bool short_ = false;  ///< the device had no room for some that were to come back last
    uint64_t left_ = 0, returned_ = 0, awaited_ = 0;
};

}  // namespace patina
