#pragma once

#include "reconstruction/stages/stages.h"
#include "reconstruction/streaming/block_stream.h"

namespace patina {

/// Voxel blocks, with the labels of their voxels. A place is a block.
class VoxelStream : public BlockStream {
  public:
    VoxelStream(graph::Runner& runner, Stages& stages, BlockStore& store);

  private:
    Leaving leave(graph::FrameGraph& graph, const gpu::StreamRegion& region, uint32_t most) override;
    uint32_t keep_left(const Leaving& leaving) override;
    graph::BufferId bring_back(graph::FrameGraph& graph, std::span<const uint32_t> keys) override;
    uint32_t places(uint32_t) const override { return 1; }
    void keep(graph::FrameGraph& graph) override;
    graph::BufferId keys_on_device(graph::FrameGraph& graph) override { return map_.import(graph).block_keys; }
    bool has_room(std::span<const uint32_t> keys) override;

    Stages& stages_;
};

}  // namespace patina
