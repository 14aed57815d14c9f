#include "passes/segmentation/segment_frame.h"

#include "passes/segmentation/draw_segments.h"
#include "shared/draw_segments.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

constexpr uint32_t kGivenIds = 65536;

}  // namespace

FrameSegments add_segment_frame(graph::Frame& frame, graph::ImageId surface, const gpu::Camera& camera,
                                const SegmentSettings& settings) {
    const graph::ImageId inner_depth_m = add_find_edges(frame, surface, camera, settings.edges);
    const Components components = add_label_components(frame, inner_depth_m, settings.connection);
    const NumberedSegments numbered =
        add_number_segments(frame, components.pixels, settings.min_pixels, settings.capacity);
    const graph::ImageId drawn = add_draw_segments(frame, components, numbered.numbers, settings.min_pixels);
    const graph::ImageId segment =
        add_claim_edges(frame, drawn, surface, camera, settings.edges, settings.claim_reach_px);
    return {segment, add_measure_segments(frame, numbered.segments, segment, surface, camera), numbered.count};
}

FrameSegments add_given_segments(graph::Frame& frame, graph::ImageId given, graph::ImageId surface,
                                 const gpu::Camera& camera, uint32_t capacity) {
    const Extent2D extent = frame.common_extent({given, surface});
    const gpu::CountGivenParams params{{extent.width, extent.height}, (extent.width + 31) / 32, kGivenIds};
    auto count = frame.compute("segmentation.count_given", spirv::count_given);
    count.read("given", given).read("surface", surface).push(params);
    const graph::BufferId pixels = count.modify("Pixels", add_empty_keys(frame, "segmentation.pixels", kGivenIds));
    count.dispatch_covering(words_of(extent));

    const NumberedSegments numbered = add_number_segments(frame, pixels, 1, capacity);
    auto draw = frame.compute("segmentation.draw_given", spirv::draw_given);
    draw.read("given", given).read("surface", surface).read("Numbers", numbered.numbers).push(params);
    const graph::ImageId segment = draw.create("segment", {extent, vulkan::Format::kR32u});
    draw.dispatch_covering(extent);
    return {segment, add_measure_segments(frame, numbered.segments, segment, surface, camera), numbered.count};
}

}  // namespace patina
