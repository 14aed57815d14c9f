#pragma once

#include "reconstruction/stages/stages.h"
#include "reconstruction/streaming/block_stream.h"

namespace patina {

/// Blocks of observed voxels, with all that is known of these. A place is a record. Needs reflectance.
///
/// Segments keep samples from one choice to the next: ids of records. In frames none of them leaves between two
/// choices. Before they leave between frames, the host takes note of where they lie; the next frame finds them there
/// again.
class RecordStream : public BlockStream {
  public:
    RecordStream(graph::Runner& runner, Stages& stages, BlockStore& store);

    /// Segments choose their samples anew with the next frame, in a region; before plan().
    void note_choice(const StreamRegion& near);
    /// Between frames: brings samples back that have left. Waits.
    void bring_samples_back();

    void reset();
    void visit(graph::StateVisitor& visitor, const std::string& name);

  private:
    Leaving leave(graph::FrameGraph& graph, const gpu::StreamRegion& region, uint32_t most) override;
    uint32_t keep_left(const Leaving& leaving) override;
    graph::BufferId bring_back(graph::FrameGraph& graph, std::span<const uint32_t> keys) override;
    uint32_t places(uint32_t key) const override;
    void keep(graph::FrameGraph& graph) override;
    graph::BufferId keys_on_device(graph::FrameGraph& graph) override;
    bool has_room(std::span<const uint32_t> keys) override;
    void prepare_to_leave() override;
    void prepare_for_frame() override { bring_samples_back(); }

    ReflectanceStage& reflectance() { return *stages_.reflectance; }

    Stages& stages_;
    StreamRegion chosen_in_;          ///< where the samples lie
    std::vector<glm::uvec2> places_;  ///< of the samples, while they may be away (add_place_samples); else empty
};

}  // namespace patina
