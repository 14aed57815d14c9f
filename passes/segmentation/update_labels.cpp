#include "passes/segmentation/update_labels.h"

#include "passes/segmentation/sample_labels.h"
#include "spirv/shaders.h"

namespace patina {

void add_update_labels(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& ids, LabelMapIds& labels,
                       SegmentTableIds& table, const SurfaceView& surface, const DueBlocks& due,
                       const FrameSegments& segments, graph::BufferId segment_labels, MapAccess access) {
    const Extent2D extent = frame.common_extent({surface.position_m, surface.normal});
    check_sampled("segmentation.update_labels", "segments", extent, frame.shape(segments.segment).extent,
                  segments.stride);
    const bool texel = access == MapAccess::kTexel;
    auto pass = frame.compute("segmentation.update_labels", texel ? spirv::update_labels_texel : spirv::update_labels);
    pass.read("Due", due.list).read("BlockKeys", ids.block_keys).read("View", surface.view);
    pass.read("position_m", surface.position_m).read("normal", surface.normal).read("segment", segments.segment);
    pass.read("SegmentLabels", segment_labels).read("Parents", table.parents).read("Partners", table.partners);
    pass.read("Tsdf", ids.tsdf);
    pass.read("Visible", surface.blocks).specialise("kVoxelChunks", map.chunks());
    pass.specialise("kSegmentStride", segments.stride);
    labels.words = pass.modify("Words", labels.words);
    labels.stamps = pass.modify("Stamps", labels.stamps);
    table.counters = pass.modify("Counters", table.counters);
    pass.dispatch_indirect(due.arguments);
}

}  // namespace patina
