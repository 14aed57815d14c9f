#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/graph/state_visitor.h"
#include "patina/frame.h"
#include "reconstruction/pipeline.h"
#include "tools/report/output_folder.h"
#include "tools/report/run_summary.h"

namespace patina::tools {

/// Frames that a session keeps out of its model (SessionOptions::hold_out). Their colours are compared in the end with
/// what the model looks like from there.
class HeldOut {
  public:
    /// Keeps such a frame; `order`: of the last frame that was added to the reconstruction before it; UINT32_MAX where
    /// there was none.
    void keep(const Frame& frame, uint32_t order);

    /// Forgets all but the first `pictures`.
    void keep_first(size_t pictures);

    void visit(graph::StateVisitor& visitor);

    /// Renders the model from where each picture was taken, at the gains of the frame that was fused before it, and
    /// scores it; and once more with a gain of its own. Writes held_out/NNNNNN.png (picture, rendering, normals) and
    /// held_out/scores.txt. Waits for the device.
    HeldOutSummary compare(Pipeline& pipeline, const SequenceInfo& info, OutputFolder& folder) const;

  private:
    struct Kept {
        uint32_t index, order;
        ColorImage color;
        RigidTransform world_from_depth;
    };

    std::vector<Kept> kept_;
};

}  // namespace patina::tools
