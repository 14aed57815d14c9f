#include "passes/segmentation/sample_labels.h"

#include "spirv/shaders.h"

namespace patina {

SampledLabels add_sample_labels(graph::Frame& frame, const VoxelMap& map, graph::BufferId labels,
                                graph::BufferId parents, const VisibleBlocks& visible, graph::ImageId position_m,
                                MapAccess access) {
    const Extent2D extent = frame.shape(position_m).extent;
    const uint64_t blocks = map.settings().capacity_blocks;
    const auto marks = frame.fill(frame.create_buffer("segmentation.marks", blocks * sizeof(uint32_t)), 0);
    SampledLabels out;
    out.blocks = frame.fill(frame.create_buffer("segmentation.blocks", (1 + blocks) * sizeof(uint32_t)), 0, 4);
    out.arguments = frame.fill(frame.create_buffer("segmentation.blocks_arguments", 16), 1);

    const bool texel = access == MapAccess::kTexel;
    auto pass = frame.compute("segmentation.sample_labels", texel ? spirv::sample_labels_texel : spirv::sample_labels);
    pass.read("position_m", position_m).read("View", visible.view).read("ViewGrid", visible.grid);
    pass.read("Labels", labels).read("Parents", parents).specialise("kVoxelChunks", map.chunks());
    out.label = pass.create("map_label", {extent, vulkan::Format::kR32u});
    pass.modify("Marks", marks);
    out.blocks = pass.modify("Surface", out.blocks);
    out.arguments = pass.modify("Arguments", out.arguments);
    pass.dispatch_covering(extent);
    return out;
}

}  // namespace patina
