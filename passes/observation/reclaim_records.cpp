#include "passes/observation/reclaim_records.h"

#include "passes/state/rebuild_table.h"
#include "shared/observation/reclaim.h"
#include "spirv/shaders.h"

namespace patina {

void add_reclaim_records(graph::FrameGraph& frame, const ObservationMap& map, ObservationMapIds& ids,
                         ReflectanceStateIds& state, const VoxelMap& voxel_map, const VoxelMapIds& voxels, float near_m,
                         const gpu::StreamRegion& region, uint32_t turn) {
    gpu::ReclaimParams params{};
    params.voxels = voxel_map.grid();
    params.edge_shift = map.edge_shift();
    params.part = turn % gpu::kReclaimParts;
    params.region = region;
    params.surface_limit = near_m / (gpu::kSdfRangeVox * voxel_map.settings().voxel_m);

    auto reclaim = frame.compute("observation.reclaim_records", spirv::reclaim_records);
    reclaim.read("VoxelKeys", voxels.keys).read("VoxelBlocks", voxels.blocks).read("Tsdf", voxels.tsdf);
    reclaim.specialise("kVoxelChunks", voxel_map.chunks()).push(params);
    ids.block_counters = reclaim.modify("BlockCounters", ids.block_counters);
    ids.record_counters = reclaim.modify("RecordCounters", ids.record_counters);
    ids.block_keys = reclaim.modify("BlockKeys", ids.block_keys);
    ids.record_table = reclaim.modify("RecordTable", ids.record_table);
    ids.records = reclaim.modify("Records", ids.records);
    ids.free_blocks = reclaim.modify("FreeBlocks", ids.free_blocks);
    ids.free_records = reclaim.modify("FreeRecords", ids.free_records);
    state.status = reclaim.modify("Status", state.status);
    state.gathered = reclaim.modify("Gathered", state.gathered);
    reclaim.dispatch_indirect(ids.block_arguments);

    add_refill_table(frame, {ids.keys, ids.blocks, ids.block_keys, ids.block_counters, ids.block_arguments},
                     map.grid());
}

}  // namespace patina
