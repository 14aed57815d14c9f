#include "passes/segmentation/draw_segments.h"

#include "shared/draw_segments.h"
#include "spirv/shaders.h"

namespace patina {

graph::ImageId add_draw_segments(graph::Frame& frame, const Components& components, graph::BufferId numbers,
                                 uint32_t min_pixels) {
    const auto [width, height] = components.extent;
    auto pass = frame.compute("segmentation.draw_segments", spirv::draw_segments);
    pass.read("Words", components.words).read("Parents", components.parents);
    pass.read("Pixels", components.pixels).read("Numbers", numbers);
    const graph::ImageId segment = pass.create("segment", {components.extent, vulkan::Format::kR32u});
    pass.push(gpu::DrawSegmentsParams{{width, height}, (width + 31) / 32, min_pixels});
    pass.dispatch_covering(words_of(components.extent));
    return segment;
}

graph::ImageId add_claim_edges(graph::Frame& frame, graph::ImageId segment, graph::ImageId surface,
                               const gpu::Camera& camera, const EdgeSettings& settings, uint32_t reach_px) {
    const Extent2D extent = frame.common_extent({segment, surface});
    gpu::ClaimEdgesParams params{};
    params.focal_center_px = camera.focal_center_px;
    params.extent = {extent.width, extent.height};
    params.noise_floor_m = settings.noise.floor_m;
    params.noise_per_m = settings.noise.per_m;
    params.step_floor_m = settings.step_floor_m;
    params.step_sigmas = settings.step_sigmas;
    params.reach_px = static_cast<int>(reach_px);
    auto pass = frame.compute("segmentation.claim_edges", spirv::claim_edges);
    pass.read("surface", surface).read("segment", segment);
    const graph::ImageId claimed = pass.create("claimed", {extent, vulkan::Format::kR32u});
    pass.push(params).dispatch_covering(extent);
    return claimed;
}

graph::BufferId add_measure_segments(graph::Frame& frame, graph::BufferId segments, graph::ImageId segment,
                                     graph::ImageId surface, const gpu::Camera& camera) {
    const Extent2D extent = frame.common_extent({segment, surface});
    auto pass = frame.compute("segmentation.measure_segments", spirv::measure_segments);
    pass.read("segment", segment).read("surface", surface);
    const graph::BufferId measured = pass.modify("Segments", segments);
    pass.push(gpu::MeasureSegmentsParams{camera, (extent.width + 31) / 32, 0, 0, 0});
    pass.dispatch_covering(words_of(extent));
    return measured;
}

}  // namespace patina
