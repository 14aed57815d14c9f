#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "engine/graph/runner.h"
#include "reconstruction/posed_fusion.h"
#include "reconstruction/stages/stages.h"

namespace patina {

/// Poses (world_from_depth) at which a frame may have been taken, the likeliest first, found by other means than
/// tracking.
using Relocaliser = std::function<std::vector<RigidTransform>(const RgbdFrame&)>;

/// Finds each frame's pose, then fuses it. The pose is known only when the graph of the search has finished; the frame,
/// whose pictures stay on the device, waits and is fused by the next frame's graph, or by fuse_waiting().
class TrackedFusion {
  public:
    /// All must outlive this; `stages` must have tracking.
    TrackedFusion(graph::Runner& runner, Stages& stages, PosedFusion& fusion);

    /// Searches for a frame's pose; waits for that. The first frame is at its own pose. Returns whether the frame
    /// tracks, and so is or will be fused. Throws Error when the device was lost or lacks memory.
    bool add(const RgbdFrame& frame);

    /// Fuses a frame at its own pose; tracking goes on from there.
    void add_posed(const RgbdFrame& frame);

    /// Fuses the frame that waits, where one does.
    void fuse_waiting();
    bool has_waiting() const { return waiting_.has_value(); }

    /// Asks `relocaliser` for poses of every frame that tracking lost, instead of the keyframes; the first from which
    /// the frame tracks is taken.
    void set_relocaliser(Relocaliser relocaliser) { relocaliser_ = std::move(relocaliser); }

    /// Nothing may be waiting.
    void visit(graph::StateVisitor& visitor) {
        visitor.value("tracking.weak_frames", weak_frames_);
        visitor.value("tracking.elsewhere", elsewhere_);
    }

    /// Frames to come were taken elsewhere: until one is found by relocalisation, none is searched for from the poses
    /// before it.
    void begin_recording() { elsewhere_ = true; }

  private:
    TrackingReport judge_first(const RgbdFrame& frame) const;
    TrackingReport track(const RgbdFrame& frame);
    TrackingReport find(const RgbdFrame& frame);
    TrackingReport best_search(const RgbdFrame& frame);
    TrackingReport first_search(const RgbdFrame& frame, const RigidTransform& start);
    TrackingReport search_again(const RgbdFrame& frame, const RigidTransform& start);
    TrackingReport search(graph::FrameGraph graph, const InputPictures& pictures, const RgbdFrame& frame,
                          const RigidTransform& start);
    std::optional<TrackingReport> relocalised(const RgbdFrame& frame);
    std::vector<RigidTransform> candidates(const RgbdFrame& frame);
    TrackingReport search_from(const RgbdFrame& frame, const RigidTransform& start);
    void cast_reference(const Intrinsics& camera, const RigidTransform& world_from_depth);
    void let_wait(const RgbdFrame& frame, const RigidTransform& world_from_depth);
    PosedFusion::Declared declare_waiting(graph::FrameGraph& graph);

    struct Waiting {
        RgbdFrame frame;  ///< at its pose, without pixels: they are in TrackingStage::pictures()
        std::vector<uint16_t> labels;
    };

    graph::Runner& runner_;
    Stages& stages_;
    TrackingStage& tracking_;
    PosedFusion& fusion_;
    Relocaliser relocaliser_;
    std::optional<Waiting> waiting_;
    uint32_t weak_frames_ = 0;  ///< the last ones, in a row
    bool elsewhere_ = false;    ///< no frame of this recording was found yet
};

}  // namespace patina
