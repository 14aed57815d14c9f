#include "passes/specular/hemi_images.h"

#include <array>

#include "shared/specular/hemi_images.h"
#include "spirv/shaders.h"

namespace patina {

static_assert(gpu::kHemiPixels == gpu::kHemiSide * gpu::kHemiSide);
static_assert(gpu::kHemiGroup * gpu::kHemiPixelsPerInvocation >= gpu::kHemiPixels);
static_assert(gpu::kParabolicMap == static_cast<uint32_t>(HemisphereMap::kParabolic));
static_assert(gpu::kOrthogonalMap == static_cast<uint32_t>(HemisphereMap::kOrthogonal));

HemiImages add_hemi_images(graph::FrameGraph& frame, const ObservationMap& map, const ObservationMapIds& records,
                           const SegmentSamples& samples, const SegmentSampleIds& sample_ids, const SegmentBatch& batch,
                           HemisphereMap hemisphere_map, uint32_t seed) {
    const gpu::HemiParams params{seed, batch.capacity, samples.labels(), static_cast<uint32_t>(hemisphere_map),
                                 map.grid().chunk_shift};
    const uint64_t images = uint64_t{batch.capacity} * gpu::kHemiSamples;
    // A group per segment, and one per image.
    const std::array work{gpu::BatchWork{1, 1, gpu::kBatchGroup, 1},
                          gpu::BatchWork{1, 1, gpu::kBatchGroup, gpu::kHemiSamples}};
    const graph::BufferId arguments = add_plan_batch(frame, batch, work);

    auto draw = frame.compute("specular.draw_voxels", spirv::draw_voxels);
    draw.read("Batch", batch.list).read("Records", records.records).push(params);
    draw.read("Counts", sample_ids.counts).read("Kept", sample_ids.kept);
    const graph::BufferId drawn = draw.create("Drawn", images * sizeof(uint32_t));
    draw.dispatch_indirect(arguments);

    auto make = frame.compute("specular.make_hemi_images", spirv::make_hemi_images);
    make.read("Records", records.records).read("Drawn", drawn).push(params);
    make.read("Directions", records.directions).read("Colors", records.colors);
    make.specialise("kVoxelChunks", map.chunks());
    const graph::BufferId filled = make.create("Images", images * gpu::kHemiPixels * sizeof(glm::vec4));
    make.dispatch_indirect(arguments, sizeof(glm::uvec4));
    return {filled, drawn};
}

}  // namespace patina
