#include "passes/segmentation/sweep_labels.h"

#include "spirv/shaders.h"

namespace patina {

void add_sweep_labels(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& ids, LabelMapIds& labels,
                      SegmentTableIds& table, graph::BufferId params) {
    auto pass = frame.compute("segmentation.sweep_labels", spirv::sweep_labels);
    pass.read("BlockKeys", ids.block_keys).read("Counters", ids.counters).read("Segmentation", params);
    pass.read("Parents", table.parents).push(map.grid());
    pass.specialise("kVoxelChunks", map.chunks());
    labels.words = pass.modify("Words", labels.words);
    table.labels = pass.modify("Labels", table.labels);
    pass.dispatch_indirect(ids.block_arguments);
}

}  // namespace patina
