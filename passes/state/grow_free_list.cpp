#include "passes/state/grow_free_list.h"

#include "shared/observation/grow_pool.h"
#include "spirv/shaders.h"

namespace patina {

void add_grow_free_list(graph::FrameGraph& frame, const char* name, graph::BufferId& free_list,
                        graph::BufferId& counters, uint32_t before, uint32_t capacity) {
    const gpu::GrowParams params{before, capacity - before};
    auto grow = frame.compute(name, spirv::grow_free_list);
    grow.push(params);
    free_list = grow.modify("FreeList", free_list);
    counters = grow.modify("Counters", counters);
    grow.dispatch_covering(params.added);
}

}  // namespace patina
