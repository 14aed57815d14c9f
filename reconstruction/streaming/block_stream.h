#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <variant>
#include <vector>

#include "engine/graph/runner.h"
#include "engine/graph/state_visitor.h"
#include "passes/state/voxel_map.h"
#include "reconstruction/streaming/block_store.h"
#include "reconstruction/streaming/packer.h"
#include "reconstruction/streaming/stream_region.h"
#include "shared/fusion/stream_blocks.h"

namespace patina {

/// What happens to blocks of one kind in a frame.
struct StreamTurn {
    bool leaves = false;      ///< blocks leave where more are in use than should be
    bool relabels = false;    ///< the labels of a part of all blocks are replaced
    bool relabelled = false;  ///< they were in the frame before
};

/// Blocks of one kind that leave the device and come back, and the store of those that are away. Which ones leave and
/// come back follows from regions, frames and keys, never from when the device has finished. Kinds differ in what they
/// have of a block: voxels (VoxelStream) or observed voxels (RecordStream). A place is what a pool has many of.
class BlockStream {
  public:
    /// What one graph moves at most.
    struct Limits {
        uint32_t leaving = 0;    ///< places
        uint32_t returning = 0;  ///< places, but for one block
    };

    BlockStream(graph::Runner& runner, const VoxelMap& map, Limits limits, BlockStore& store);
    virtual ~BlockStream() = default;
    BlockStream(const BlockStream&) = delete;
    BlockStream& operator=(const BlockStream&) = delete;

    /// Nothing is away; whenever the map is reset.
    void reset();

    /// Decides what leaves and comes back with a frame whose passes look at blocks of `near`. The frame before the last
    /// has finished.
    void plan(const StreamRegion& near, StreamTurn turn);
    /// What comes back with the frame that was planned.
    uint32_t coming_blocks() const { return static_cast<uint32_t>(coming_.size()); }
    uint32_t coming_places() const;
    /// Moves what is more than one frame takes along, in graphs of its own.
    void move_surplus();
    /// Adds to the frame what was planned; before its other passes.
    void add(graph::FrameGraph& graph);
    /// In a frame that relabels `part`, after its passes: by which labels it replaces labels.
    void await_relabelling(graph::FrameGraph& graph, uint32_t part, graph::BufferId parents);
    /// The frame's graph was submitted. Without this call, nothing of it has happened.
    void note_submitted();

    /// Between frames: brings the blocks of a region back, and takes others away where their places are needed. Waits.
    /// Returns whether all are there. The next frame finds the places as if this had not been (plan()).
    bool require(const StreamRegion& region);

    /// The keys of all blocks, wherever they are. Waits.
    std::vector<uint32_t> keys();

    /// Takes note of what the device has finished.
    void collect();
    /// Waits for the device, and takes note of everything.
    void collect_all();

    uint64_t left() const { return left_; }          ///< places over the whole run
    uint64_t returned() const { return returned_; }  ///< blocks, likewise
    uint64_t awaited() const { return awaited_; }    ///< of these, those that had not come back ahead of their frame

    /// The device must have finished.
    void visit(graph::StateVisitor& visitor, const std::string& name);

  protected:
    struct Leaving {
        glm::dvec3 center_m{0}, axis{0};  ///< of the region outside of which they lay
        graph::Readback counts{};         ///< u32[gpu::kLeavingBins], at least
        graph::Readback blocks{};         ///< gpu::StreamedBlock, and how many of them are listed
        graph::Readback count{};
        std::vector<graph::Readback> words{};  ///< of blocks, as the kind has them
    };

    /// What a read-back holds, for as long as it is there.
    template <class T>
    static std::span<const T> elements(const graph::Readback& read) {
        return {reinterpret_cast<const T*>(read.bytes().data()), read.bytes().size() / sizeof(T)};
    }

    /// Declares that blocks outside a region leave, at most so many places.
    virtual Leaving leave(graph::FrameGraph& graph, const gpu::StreamRegion& region, uint32_t most) = 0;
    /// Puts what has left into the store. Returns how many places that were.
    virtual uint32_t keep_left(const Leaving& leaving) = 0;
    /// Declares that these blocks come back, from the store. Returns the list of gpu::StreamedBlock, in this order.
    virtual graph::BufferId bring_back(graph::FrameGraph& graph, std::span<const uint32_t> keys) = 0;
    /// Of a block that is away.
    virtual uint32_t places(uint32_t key) const = 0;
    /// Marks all that the kind writes as needed after a graph of its own.
    virtual void keep(graph::FrameGraph& graph) = 0;
    /// Between frames, before blocks leave that frames count on to be there.
    virtual void prepare_to_leave() {}
    /// A frame follows after that.
    virtual void prepare_for_frame() {}
    /// What is in use, u32 per block: its key, or gpu::kEmptyKey.
    virtual graph::BufferId keys_on_device(graph::FrameGraph& graph) = 0;
    /// Whether the places that are free suffice for blocks that are away.
    virtual bool has_room(std::span<const uint32_t> keys) = 0;

    graph::Runner& runner_;
    const VoxelMap& map_;
    BlockStore& store_;
    Packer packer_;

  private:
    struct Returning {
        std::vector<std::pair<uint32_t, BlockStore::Kept>> kept;  ///< until the device has them
        graph::Readback blocks;
    };
    struct Relabelled {
        uint32_t part;
        graph::Readback parents;
    };
    using Event = std::variant<Leaving, Returning, Relabelled>;

    template <class Kind>
    bool pends() const;
    bool would_miss(const StreamRegion& near) const;
    void roll_back();
    void note(const Leaving& leaving);
    void note(Returning& returning);
    void note(const Relabelled& relabelled);
    void add_leaving(graph::FrameGraph& graph, const StreamRegion& region);
    void add_returning(graph::FrameGraph& graph, std::span<const uint32_t> keys);
    /// How many of these, the first ones, one graph takes.
    size_t at_once(std::span<const uint32_t> keys) const;
    void submit(graph::FrameGraph graph);
    void make_room(const StreamRegion& region, std::span<const uint32_t> keys);
    uint32_t leave_now(const StreamRegion& region);

    Limits limits_;
    std::vector<Event> declared_;        ///< of a graph that is not submitted yet
    std::deque<Event> pending_;          ///< of graphs that the device may work on
    std::vector<uint32_t> coming_;       ///< keys that come back with the next frame, those that it needs first
    std::optional<StreamRegion> keeps_;  ///< outside of which blocks leave with the next frame
    uint32_t left_outside_ = 0;          ///< places outside that had to stay when some left last: they were too many
    bool disturbed_ = false;             ///< blocks came back between frames, after the last one
    bool short_ = false;                 ///< the device had no room for some that were to come back last
    uint64_t left_ = 0, returned_ = 0, awaited_ = 0;
};

}  // namespace patina
