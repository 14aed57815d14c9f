#include "passes/segmentation/update_labels.h"

#include "spirv/shaders.h"

namespace patina {

UpdatedLabels add_update_labels(graph::Frame& frame, const VoxelMap& map, const ClaimedVoxels& claimed,
                                SegmentTableIds& table, const FrameSegments& segments, graph::BufferId segment_labels) {
    const Extent2D extent = frame.common_extent({segments.segment, claimed.label, claimed.voxel});
    auto pass = frame.compute("segmentation.update_labels", spirv::update_labels);
    pass.read("segment", segments.segment).read("map_label", claimed.label).read("voxel", claimed.voxel);
    pass.read("Parents", table.parents).read("SegmentLabels", segment_labels);
    pass.specialise("kVoxelChunks", map.chunks()).push(gpu::UpdateLabelsParams{map.grid().chunk_shift, 0, 0, 0});
    UpdatedLabels out;
    out.label = pass.create("label", {extent, vulkan::Format::kR32u});
    out.words = pass.modify("Words", claimed.words);
    table.counters = pass.modify("Counters", table.counters);
    pass.dispatch_covering(extent);
    return out;
}

}  // namespace patina
