#include "passes/segmentation/relabel_away.h"

#include "shared/reflectance/reflectance.h"
#include "spirv/shaders.h"

namespace patina {

void add_relabel_away(graph::FrameGraph& frame, graph::BufferId& away, const SegmentTableIds& table,
                      graph::BufferId params) {
    auto pass = frame.compute("segmentation.relabel_away", spirv::relabel_away);
    pass.read("Parents", table.parents).read("Segmentation", params);
    const uint64_t labels = frame.bytes(away) / (gpu::kSweepParts * sizeof(gpu::SegmentAlbedo));
    away = pass.modify("Away", away);
    pass.dispatch_covering(static_cast<uint32_t>(labels));
}

}  // namespace patina
