#include "passes/specular/fuse_estimates.h"

#include "engine/core/error.h"
#include "spirv/shaders.h"

namespace patina {

void add_fuse_estimates(graph::FrameGraph& frame, const SegmentBatch& batch, graph::BufferId estimates,
                        graph::BufferId drawn, const SpecularEstimates& table, SpecularEstimateIds& ids, float weight) {
    if (!(weight > 0)) {
        throw Error("the pass 'specular.fuse_estimates' got the weight ", weight, ", it must be above 0");
    }
    auto pass = frame.compute("specular.fuse_estimates", spirv::fuse_estimates);
    pass.read("Batch", batch.list).read("Drawn", drawn).read("Estimates", estimates);
    ids.means = pass.modify("Means", ids.means);
    ids.materials = pass.modify("Materials", ids.materials);
    pass.push(gpu::FuseEstimatesParams{batch.capacity, table.labels(), weight});
    pass.dispatch_covering(batch.capacity);
}

}  // namespace patina
