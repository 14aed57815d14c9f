#include "passes/segmentation/list_due_blocks.h"

#include "shared/segmentation/segments.h"
#include "spirv/shaders.h"

namespace patina {

DueBlocks add_list_due_blocks(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& ids,
                              LabelMapIds& labels, graph::BufferId visible, uint32_t stamp) {
    const uint64_t entries = 1 + map.capacity();
    DueBlocks out;
    out.list = frame.fill(frame.create_buffer("segmentation.due", entries * sizeof(uint32_t)), 0, 4);
    out.arguments = frame.fill(frame.create_buffer("segmentation.due_arguments", 16), 1);
    auto pass = frame.compute("segmentation.list_due_blocks", spirv::list_due_blocks);
    pass.read("Visible", visible).read("BlockKeys", ids.block_keys).push(gpu::ListDueBlocksParams{stamp, 0, 0, 0});
    labels.stamps = pass.modify("Stamps", labels.stamps);
    out.list = pass.modify("Due", out.list);
    out.arguments = pass.modify("Arguments", out.arguments);
    // There are no more visible blocks than blocks.
    pass.dispatch_indirect(ids.block_arguments);
    return out;
}

}  // namespace patina
