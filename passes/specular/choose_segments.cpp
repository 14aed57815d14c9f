#include "passes/specular/choose_segments.h"

#include "spirv/shaders.h"

namespace patina {

ChosenSegments add_choose_segments(graph::FrameGraph& frame, const ChooseSegmentsInputs& inputs, uint32_t capacity,
                                   SpecularMaterialIds& ids) {
    const gpu::ChooseSegmentsParams params{inputs.stamp, inputs.label_count, inputs.materials, capacity};
    auto count = frame.compute("specular.count_changes", spirv::count_changes);
    count.read("Changed", inputs.changed.list).read("Records", inputs.records).push(params);
    ids.fits.progress = count.modify("Progress", ids.fits.progress);
    count.dispatch_indirect(inputs.changed.arguments);

    auto choose = frame.compute("specular.choose_segments", spirv::choose_segments);
    choose.read("Labels", inputs.labels).read("Counts", inputs.counts).push(params);
    ids.fits.progress = choose.modify("Progress", ids.fits.progress);
    ids.fits.fits = choose.modify("Fits", ids.fits.fits);
    ids.fits.mirrors = choose.modify("Mirrors", ids.fits.mirrors);
    ids.estimates.means = choose.modify("Means", ids.estimates.means);
    ids.estimates.materials = choose.modify("Estimates", ids.estimates.materials);
    ids.materials = choose.modify("Materials", ids.materials);
    const uint64_t bytes = (1 + uint64_t{capacity}) * sizeof(uint32_t);
    const graph::BufferId all = choose.create("Batch", bytes), doubtful = choose.create("Doubtful", bytes);
    choose.dispatch(1);
    return {{all, capacity}, {doubtful, capacity}};
}

void add_adopt_estimates(graph::FrameGraph& frame, const SegmentBatch& batch, uint32_t materials,
                         SpecularMaterialIds& ids) {
    auto pass = frame.compute("specular.adopt_estimates", spirv::adopt_estimates);
    pass.read("Batch", batch.list).read("Estimates", ids.estimates.materials);
    pass.push(gpu::ChooseSegmentsParams{0, 0, materials, batch.capacity});
    ids.fits.fits = pass.modify("Fits", ids.fits.fits);
    ids.materials = pass.modify("Materials", ids.materials);
    pass.dispatch_covering(batch.capacity);
}

}  // namespace patina
