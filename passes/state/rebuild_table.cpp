#include "passes/state/rebuild_table.h"

#include <cstddef>
#include <span>

#include "spirv/shaders.h"

namespace patina {

void add_rebuild_table(graph::FrameGraph& frame, const BlockTable& table, const gpu::VoxelGrid& grid) {
    auto rebuild = frame.compute("fusion.rebuild_table", spirv::rebuild_table);
    rebuild.read("BlockKeys", table.block_keys).push(grid);
    table.keys = rebuild.modify("Keys", table.keys);
    table.blocks = rebuild.modify("Blocks", table.blocks);
    table.counters = rebuild.modify("Counters", table.counters);
    rebuild.dispatch_indirect(table.block_arguments);
}

void add_refill_table(graph::FrameGraph& frame, const BlockTable& table, const gpu::VoxelGrid& grid) {
    constexpr uint32_t kNone = 0;
    table.keys = frame.fill(table.keys, gpu::kEmptyKey);
    table.counters = frame.upload_bytes(table.counters, offsetof(gpu::MapCounters, table_keys),
                                        std::as_bytes(std::span(&kNone, 1)), false);
    add_rebuild_table(frame, table, grid);
}

}  // namespace patina
