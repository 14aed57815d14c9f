#include "passes/segmentation/grow_labels.h"

#include "shared/observation/grow_pool.h"
#include "spirv/shaders.h"

namespace patina {

void add_grow_labels(graph::FrameGraph& frame, const SegmentTable& table, SegmentTableIds& ids, uint32_t before) {
    auto grow = frame.compute("segmentation.grow_labels", spirv::grow_labels);
    grow.push(gpu::GrowParams{before, table.capacity() - before});
    ids.free_labels = grow.modify("FreeLabels", ids.free_labels);
    ids.counters = grow.modify("Counters", ids.counters);
    grow.dispatch(1);
}

}  // namespace patina
