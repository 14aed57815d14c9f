#include "passes/fusion/grow_voxels.h"

#include "passes/state/grow_free_list.h"
#include "passes/state/rebuild_table.h"

namespace patina {

void add_grow_voxels(graph::FrameGraph& frame, const VoxelMap& map, VoxelMapIds& ids, uint32_t before) {
    add_grow_free_list(frame, "fusion.grow_free_list", ids.free_list, ids.counters, before, map.capacity());
    add_rebuild_table(frame, {ids.keys, ids.blocks, ids.block_keys, ids.counters, ids.block_arguments}, map.grid());
}

}  // namespace patina
