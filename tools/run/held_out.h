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

/// Colour pictures that a run keeps out of its model, to compare them in the end with what the model looks like from
/// there.
class HeldOut {
  public:
    /// Every `every`-th frame of the sequence, from its every-th on; 0: none.
    explicit HeldOut(uint32_t every) : every_(every) {}

    /// Keeps a frame if it is one of these; `order`: how many frames were added to the reconstruction before it.
    void keep(const Frame& frame, uint32_t order);

    void visit(graph::StateVisitor& visitor);

    /// Renders the model from where each picture was taken, at that picture's gains, and scores it. Writes
    /// held_out/NNNNNN.png (picture, rendering, normals) and held_out/scores.txt. Waits for the device.
    HeldOutSummary compare(Pipeline& pipeline, const SequenceInfo& info, OutputFolder& folder) const;

  private:
    struct Kept {
        uint32_t index, order;
        ColorImage color;
        RigidTransform world_from_depth;
    };

    uint32_t every_;
    std::vector<Kept> kept_;
};

}  // namespace patina::tools
