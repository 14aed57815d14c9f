#pragma once

#include "reconstruction/stages/stages.h"
#include "reconstruction/streaming/block_stream.h"

namespace patina {

/// Blocks of observed voxels, with all that is known of these. A place is a record. Needs reflectance.
class RecordStream : public BlockStream {
  public:
    RecordStream(graph::Runner& runner, Stages& stages, BlockStore& store);

  private:
    Leaving leave(graph::FrameGraph& graph, const gpu::StreamRegion& region, uint32_t most) override;
    uint32_t keep_left(const Leaving& leaving) override;
    graph::BufferId bring_back(graph::FrameGraph& graph, std::span<const uint32_t> keys) override;
    uint32_t places(uint32_t key) const override;
    void keep(graph::FrameGraph& graph, bool left) override;
    graph::BufferId keys_on_device(graph::FrameGraph& graph) override;
    bool has_room(std::span<const uint32_t> keys) override;

    ReflectanceStage& reflectance() { return *stages_.reflectance; }

    Stages& stages_;
};

}  // namespace patina
