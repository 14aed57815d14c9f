#include "passes/state/segment_batch.h"

#include "engine/core/error.h"
#include "spirv/shaders.h"

namespace patina {

graph::BufferId add_plan_batch(graph::FrameGraph& frame, const SegmentBatch& batch,
                               std::span<const gpu::BatchWork> work) {
    constexpr uint64_t kMostGroups = 65535;
    if (batch.capacity == 0) throw Error("a batch of segments has a capacity of 0, it must be at least 1");
    for (const gpu::BatchWork& each : work) {
        const uint64_t images = uint64_t{batch.capacity} * each.images;
        const uint64_t tiles = (images + each.images_per_tile - 1) / each.images_per_tile;
        const uint64_t groups = (tiles * each.items_per_tile + gpu::kBatchGroup - 1) / gpu::kBatchGroup;
        if (groups <= kMostGroups) continue;
        throw Error("a batch of ", batch.capacity, " segments takes ", groups, " groups, at most ", kMostGroups,
                    " can be dispatched");
    }
    const auto passes = static_cast<uint32_t>(work.size());
    auto pass = frame.compute("specular.plan_batch", spirv::plan_batch);
    pass.read("Batch", batch.list).read("Work", frame.upload<gpu::BatchWork>("specular.work", work));
    const graph::BufferId arguments = pass.create("Arguments", passes * sizeof(glm::uvec4));
    pass.push(gpu::BatchParams{passes, batch.capacity});
    pass.dispatch_covering(passes);
    return arguments;
}

}  // namespace patina
