#include "passes/fusion/remove_empty_blocks.h"

#include "passes/state/rebuild_table.h"
#include "spirv/shaders.h"

namespace patina {

void add_remove_empty_blocks(graph::FrameGraph& frame, const VoxelMap& map, VoxelMapIds& ids,
                             const VisibleBlocks& visible, graph::BufferId params) {
    auto remove = frame.compute("fusion.remove_empty_blocks", spirv::remove_empty_blocks);
    remove.read("Visible", visible.list).read("Fusion", params).read("Tsdf", ids.tsdf);
    remove.specialise("kVoxelChunks", map.chunks());
    ids.block_keys = remove.modify("BlockKeys", ids.block_keys);
    ids.free_list = remove.modify("FreeList", ids.free_list);
    ids.counters = remove.modify("Counters", ids.counters);
    remove.dispatch_indirect(visible.arguments);

    add_refill_table(frame, {ids.keys, ids.blocks, ids.block_keys, ids.counters, ids.block_arguments}, map.grid());
}

}  // namespace patina
