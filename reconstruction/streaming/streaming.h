#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/graph/runner.h"
#include "engine/graph/state_visitor.h"
#include "reconstruction/growing_pools.h"
#include "reconstruction/stages/stages.h"
#include "reconstruction/streaming/block_store.h"
#include "reconstruction/streaming/record_stream.h"
#include "reconstruction/streaming/stream_region.h"
#include "reconstruction/streaming/voxel_stream.h"

namespace patina {

/// How much of one kind is where.
struct StreamCounts {
    uint64_t away = 0;      ///< voxel blocks, or observed voxels, that the device does not have
    uint64_t left = 0;      ///< likewise, over the whole run
    uint64_t returned = 0;  ///< blocks that came back, over the whole run
    uint64_t awaited = 0;   ///< of these, those that a frame had to wait for, as they had not come back ahead of it
    uint64_t filed = 0;     ///< blocks that went to the temporary file, since the run began or went on
};

/// Takes what is far from the camera off the device while much is in use: voxel blocks, and observed voxels with all
/// that is known of them. Brings it back before a frame looks at it: every block of the region that its passes look at
/// is on the device, unless a pool is full. So nothing that a frame computes depends on what is away. What leaves
/// follows poses, frame numbers and keys.
///
/// Labels of what is away take part in the sweeps over all labels, as if it were on the device: a sweep counts them,
/// and its replacement of labels reaches them when the device has finished the frame. For that, blocks leave in frames
/// after which the host knows them by the next sweep. What a segment reflects on the whole counts what is away
/// (AwayAlbedo). The samples that segments keep are of what is near, which is on the device; observed voxels leave in
/// frames in which these are chosen anew.
class Streaming {
  public:
    /// Both must outlive this.
    Streaming(graph::Runner& runner, Stages& stages);

    /// Nothing is away; whenever the map is reset.
    void reset();

    /// No observed voxels are away; whenever they are forgotten.
    void forget_records();

    /// Of which kinds more is in use than should be.
    struct Many {
        bool blocks = false, records = false;
    };
    /// Decides what leaves and returns with frame `index`, whose passes look at blocks of `near`. The frame before the
    /// last has finished. Returns the places that what comes back takes.
    ComingPlaces plan(const StreamRegion& near, uint32_t index, Many many);
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

    /// Between frames: brings the voxel blocks, or the observed voxels, of a region back, and takes others away where
    /// their places are needed. Waits. Returns whether all are there.
    bool require_blocks(const StreamRegion& region) { return voxels_.require(region); }
    bool require_records(const StreamRegion& region) { return !records_ || records_->require(region); }

    /// The coordinates of all voxel blocks of the map, or of all blocks with observed voxels, wherever they are. Waits.
    std::vector<glm::ivec3> blocks() { return coordinates(voxels_); }
    std::vector<glm::ivec3> observed_blocks();

    /// As far as the device has finished.
    bool any_blocks_away();
    bool any_records_away();
    /// As far as the device has finished.
    StreamCounts block_counts();
    StreamCounts record_counts();
    /// A sentence where memory holds more than it should; else empty.
    std::string problem() const;

    /// Between frames: all that frames count on is where they expect it, whatever was required before. Waits.
    void prepare_visit();
    /// The device must have finished.
    void visit(graph::StateVisitor& visitor);

  private:
    std::vector<glm::ivec3> coordinates(BlockStream& stream);

    Stages& stages_;
    BlockStore block_store_, record_store_;
    VoxelStream voxels_;
    std::optional<RecordStream> records_;  ///< with reflectance
    std::vector<uint32_t> labels_away_;
};

}  // namespace patina
