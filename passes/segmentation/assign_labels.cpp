#include "passes/segmentation/assign_labels.h"

#include "spirv/shaders.h"

namespace patina {

graph::BufferId add_assign_labels(graph::FrameGraph& frame, SegmentTableIds& table, const FrameSegments& segments,
                                  const SegmentOverlaps& overlaps, KnownMaterials& materials, graph::BufferId params) {
    constexpr uint64_t kEntries = gpu::kMaxFrameSegments + 1;
    auto pass = frame.compute("segmentation.assign_labels", spirv::assign_labels);
    pass.read("Segments", segments.segments).read("SegmentCount", segments.count).read("Segmentation", params);
    pass.read("Overlaps", overlaps.table).read("OverlapList", overlaps.list);
    const auto zeros = [&](const char* name, uint64_t bytes) {
        return frame.fill(frame.create_buffer(name, bytes), 0);
    };
    pass.modify("Votes", zeros("segmentation.votes", kEntries * sizeof(gpu::SegmentVote)));
    const graph::BufferId assigned =
        pass.modify("SegmentLabels", zeros("segmentation.segment_labels", kEntries * sizeof(uint32_t)));
    table.parents = pass.modify("Parents", table.parents);
    table.partners = pass.modify("Partners", table.partners);
    table.rules = pass.modify("Rules", table.rules);
    table.labels = pass.modify("Labels", table.labels);
    table.pairs = pass.modify("Pairs", table.pairs);
    table.free_labels = pass.modify("FreeLabels", table.free_labels);
    materials.kd = pass.modify("SegmentKds", materials.kd);
    pass.read("Fits", materials.fits);
    table.counters = pass.modify("Counters", table.counters);
    pass.dispatch(1);
    return assigned;
}

}  // namespace patina
