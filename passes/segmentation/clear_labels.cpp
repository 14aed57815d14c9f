#include "passes/segmentation/clear_labels.h"

#include "spirv/shaders.h"

namespace patina {

void add_clear_labels(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& ids, LabelMapIds& labels) {
    auto pass = frame.compute("segmentation.clear_labels", spirv::clear_labels);
    pass.read("NewSlots", ids.new_slots).read("Blocks", ids.blocks).read("Counters", ids.counters).push(map.grid());
    pass.specialise("kVoxelChunks", map.chunks());
    labels.words = pass.modify("Words", labels.words);
    labels.stamps = pass.modify("Stamps", labels.stamps);
    pass.dispatch_indirect(ids.assign_arguments);
}

}  // namespace patina
