#include "passes/specular/fit_mirrors.h"

#include <array>

#include "spirv/shaders.h"

namespace patina {

static_assert(gpu::kMirrorGroup == gpu::kBatchGroup && gpu::kSegmentSamples % gpu::kMirrorGroup == 0);

void add_fit_mirrors(graph::FrameGraph& frame, const FitMirrorsInputs& inputs, const SegmentBatch& batch,
                     const WardFits& table, WardFitIds& fits, graph::BufferId& segment_materials) {
    const ObservationMapIds& records = inputs.records;
    const gpu::MirrorParams params{inputs.map.grid(),
                                   inputs.map.edge_shift(),
                                   table.labels(),
                                   inputs.materials,
                                   inputs.stamp,
                                   inputs.memory,
                                   0,
                                   0,
                                   0};
    const std::array work{gpu::BatchWork{1, 1, gpu::kSegmentSamples, 1},
                          gpu::BatchWork{1, 1, gpu::kSegmentSamples * gpu::kMirrorSets, 1},
                          gpu::BatchWork{1, 1, gpu::kBatchGroup, 1}};
    const graph::BufferId arguments = add_plan_batch(frame, batch, work);

    auto choose = frame.compute("specular.choose_mirror_pairs", spirv::choose_mirror_pairs);
    choose.read("Batch", batch.list).read("Records", records.records).push(params);
    choose.read("Counts", inputs.sample_ids.counts).read("Kept", inputs.sample_ids.kept);
    choose.read("Directions", records.directions).read("Colors", records.colors);
    choose.specialise("kVoxelChunks", inputs.map.chunks());
    const uint64_t pair_count = uint64_t{batch.capacity} * gpu::kSegmentSamples;
    const graph::BufferId pairs = choose.create("Pairs", pair_count * sizeof(gpu::MirrorPair));
    choose.dispatch_indirect(arguments);

    auto march = frame.compute("specular.march_mirrors", spirv::march_mirrors);
    march.read("Records", records.records).read("Pairs", pairs).read("Surroundings", inputs.surroundings).push(params);
    const graph::BufferId mirrored = march.create("Mirrored", pair_count * gpu::kMirrorSets * sizeof(glm::vec4));
    march.dispatch_indirect(arguments, sizeof(glm::uvec4));

    auto fit = frame.compute("specular.fit_mirrors", spirv::fit_mirrors);
    fit.read("Batch", batch.list).read("Pairs", pairs).read("Mirrored", mirrored).push(params);
    fits.mirrors = fit.modify("Mirrors", fits.mirrors);
    segment_materials = fit.modify("Materials", segment_materials);
    fit.dispatch_indirect(arguments, 2 * sizeof(glm::uvec4));
}

}  // namespace patina
