#include "passes/specular/fit_ward.h"

#include <algorithm>
#include <array>

#include "spirv/shaders.h"

namespace patina {

static_assert(gpu::kFitAlphas % gpu::kFitAlphasPerGroup == 0 && gpu::kFitAlphas <= gpu::kFitGroup);
static_assert(gpu::kFitAlphasPerGroup % 4 == 0, "four are added up at once");
static_assert(gpu::kFitGroup == gpu::kBatchGroup && gpu::kSegmentSamples % gpu::kFitGroup == 0);

void add_fit_ward(graph::FrameGraph& frame, const FitWardInputs& inputs, const SegmentBatch& batch,
                  const WardFits& table, WardFitIds& fits, graph::BufferId& segment_materials) {
    const ObservationMapIds& records = inputs.records;
    const gpu::FitParams params{inputs.map.grid(),
                                inputs.map.edge_shift(),
                                table.labels(),
                                inputs.materials,
                                inputs.position_version,
                                inputs.memory,
                                0,
                                0,
                                0};
    const uint64_t voxel_count = uint64_t{batch.capacity} * gpu::kSegmentSamples;
    // A group per segment; one per some of its voxels; and one per segment and block of alphas.
    const std::array work{gpu::BatchWork{1, 1, gpu::kBatchGroup, 1}, gpu::BatchWork{1, 1, gpu::kSegmentSamples, 1},
                          gpu::BatchWork{1, 1, gpu::kBatchGroup, gpu::kFitAlphas / gpu::kFitAlphasPerGroup}};
    const graph::BufferId arguments = add_plan_batch(frame, batch, work);

    auto choose = frame.compute("specular.choose_voxels", spirv::choose_voxels);
    choose.read("Batch", batch.list).read("Records", records.records).push(params);
    choose.read("Counts", inputs.sample_ids.counts).read("Kept", inputs.sample_ids.kept);
    choose.read("Visibility", records.visibility).read("Status", inputs.status);
    choose.read("Keys", records.keys).read("Blocks", records.blocks).read("RecordTable", records.record_table);
    choose.read("Fits", fits.fits).read("Curves", fits.curves);
    const graph::BufferId before = choose.create("Before", batch.capacity * gpu::kFitAlphas * sizeof(glm::vec4));
    const graph::BufferId voxels = choose.create("Voxels", voxel_count * sizeof(gpu::FitVoxel));
    choose.dispatch_indirect(arguments);

    auto weigh = frame.compute("specular.weigh_observations", spirv::weigh_observations);
    weigh.read("Lights", inputs.lights).read("Batch", batch.list).read("Voxels", voxels).push(params);
    weigh.read("Records", records.records).read("Visibility", records.visibility).read("Fits", fits.fits);
    weigh.read("Directions", records.directions).read("Colors", records.colors);
    weigh.specialise("kVoxelChunks", inputs.map.chunks());
    const graph::BufferId weights = weigh.create("Weights", voxel_count * gpu::kMaxObservations * sizeof(float));
    weigh.dispatch_indirect(arguments, sizeof(glm::uvec4));

    auto sum = frame.compute("specular.sum_lobes", spirv::sum_lobes);
    sum.read("Lights", inputs.lights).read("Voxels", voxels).read("Records", records.records).push(params);
    sum.read("Visibility", records.visibility).read("Weights", weights).read("Before", before);
    sum.read("Directions", records.directions).read("Colors", records.colors);
    sum.specialise("kVoxelChunks", inputs.map.chunks());
    const graph::BufferId sums = sum.create("Sums", uint64_t{batch.capacity} * gpu::kFitAlphas * sizeof(gpu::FitSums));
    sum.dispatch_indirect(arguments, 2 * sizeof(glm::uvec4));

    auto solve = frame.compute("specular.solve_ward", spirv::solve_ward);
    solve.read("Batch", batch.list).read("Sums", sums).read("Network", inputs.network);
    solve.read("Mirrors", fits.mirrors);
    solve.push(params);
    fits.curves = solve.modify("Curves", fits.curves);
    fits.fits = solve.modify("Fits", fits.fits);
    segment_materials = solve.modify("Materials", segment_materials);
    solve.dispatch_indirect(arguments);

    auto diffuse = frame.compute("specular.fit_diffuse", spirv::fit_diffuse);
    diffuse.read("Lights", inputs.lights).read("Batch", batch.list).read("Voxels", voxels).push(params);
    diffuse.read("Records", records.records).read("Visibility", records.visibility).read("Weights", weights);
    diffuse.read("Directions", records.directions).read("Colors", records.colors);
    diffuse.specialise("kVoxelChunks", inputs.map.chunks());
    fits.fits = diffuse.modify("Fits", fits.fits);
    diffuse.dispatch_indirect(arguments);
}

std::optional<glm::vec3> kd_of(const gpu::WardFit& fit) {
    const glm::vec3 light2(fit.light2);
    if (!(std::min({light2.r, light2.g, light2.b}) > 0)) return std::nullopt;
    return glm::clamp(glm::vec3(fit.diffuse) / light2, 0.0f, 1.0f);
}

}  // namespace patina
