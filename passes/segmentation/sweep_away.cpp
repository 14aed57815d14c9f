#include "passes/segmentation/sweep_away.h"

#include "spirv/shaders.h"

namespace patina {

void add_sweep_away(graph::FrameGraph& frame, SegmentTableIds& table, graph::BufferId away) {
    auto pass = frame.compute("segmentation.sweep_away", spirv::sweep_away);
    pass.read("Parents", table.parents).read("Away", away);
    table.labels = pass.modify("Labels", table.labels);
    pass.dispatch_covering(static_cast<uint32_t>(frame.bytes(away) / sizeof(uint32_t)));
}

}  // namespace patina
