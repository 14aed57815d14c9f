#include "passes/fusion/grow_voxels.h"

#include "passes/state/rebuild_table.h"
#include "shared/observation/grow_pool.h"
#include "spirv/shaders.h"

namespace patina {

void add_grow_voxels(graph::FrameGraph& frame, const VoxelMap& map, VoxelMapIds& ids, uint32_t before) {
    const gpu::GrowParams params{before, map.capacity() - before};
    auto grow = frame.compute("fusion.grow_free_list", spirv::grow_free_list);
    grow.push(params);
    ids.free_list = grow.modify("FreeList", ids.free_list);
    ids.counters = grow.modify("Counters", ids.counters);
    grow.dispatch_covering(params.added);
    add_rebuild_table(frame, {ids.keys, ids.blocks, ids.block_keys, ids.counters, ids.block_arguments}, map.grid());
}

}  // namespace patina
