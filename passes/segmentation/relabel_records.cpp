#include "passes/segmentation/relabel_records.h"

#include "spirv/shaders.h"

namespace patina {

void add_relabel_records(graph::FrameGraph& frame, const ObservationMap& map, ObservationMapIds& records,
                         const SegmentTableIds& table, graph::BufferId params) {
    auto pass = frame.compute("segmentation.relabel_records", spirv::relabel_records);
    pass.read("BlockKeys", records.block_keys).read("Counters", records.block_counters);
    pass.read("RecordTable", records.record_table).read("Segmentation", params).read("Parents", table.parents);
    pass.push(gpu::RelabelParams{map.edge_shift(), 0, 0, 0});
    records.records = pass.modify("Records", records.records);
    pass.dispatch_indirect(records.block_arguments);
}

}  // namespace patina
