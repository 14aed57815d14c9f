#include "passes/observation/grow_observations.h"

#include "passes/state/grow_free_list.h"
#include "passes/state/rebuild_table.h"
#include "shared/observation/grow_pool.h"
#include "spirv/shaders.h"

namespace patina {

void add_grow_observed_blocks(graph::FrameGraph& frame, const ObservationMap& map, ObservationMapIds& ids,
                              uint32_t before) {
    add_grow_free_list(frame, "observation.grow_free_blocks", ids.free_blocks, ids.block_counters, before,
                       map.capacity_blocks());
    add_rebuild_table(frame, {ids.keys, ids.blocks, ids.block_keys, ids.block_counters, ids.block_arguments},
                      map.grid());
}

void add_grow_records(graph::FrameGraph& frame, const ObservationMap& map, ObservationMapIds& ids, uint32_t before) {
    add_grow_free_list(frame, "observation.grow_free_records", ids.free_records, ids.record_counters, before,
                       map.capacity_records());
    auto retry = frame.compute("observation.retry_records", spirv::retry_records);
    retry.read("Counters", ids.block_counters).push(gpu::RetryParams{1u << 3 * map.edge_shift()});
    ids.record_table = retry.modify("RecordTable", ids.record_table);
    retry.dispatch_indirect(ids.block_arguments);
}

}  // namespace patina
