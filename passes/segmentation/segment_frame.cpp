#include "passes/segmentation/segment_frame.h"

#include "passes/segmentation/label_components.h"
#include "passes/segmentation/number_segments.h"
#include "shared/number_segments.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

constexpr uint32_t kGivenIds = 65536;

}  // namespace

FrameSegments add_segment_frame(graph::Frame& frame, graph::ImageId model_position_m, graph::ImageId reading_m,
                                const gpu::Camera& camera, const SegmentSettings& settings,
                                const std::optional<ColorGuide>& colors) {
    const gpu::FrameSurfaceParams params = make_surface_params(camera, settings.edges, settings.min_pixels);
    const graph::ImageId depth_m = add_choose_depth(frame, model_position_m, reading_m, params);
    const graph::ImageId normal = add_fit_normals(frame, depth_m, params);
    graph::ImageId inner_depth_m = add_find_edges(frame, depth_m, normal, params);
    if (colors) inner_depth_m = add_cut_colors(frame, inner_depth_m, camera, *colors);
    const auto [component, pixels] = add_label_components(frame, inner_depth_m, params.jump_m, params.jump_slope);
    const graph::ImageId claimed = add_claim_edges(frame, component, pixels, depth_m, normal, params);
    return add_number_segments(frame, pixels, claimed, depth_m, camera, settings.min_pixels, settings.capacity);
}

FrameSegments add_given_segments(graph::Frame& frame, graph::ImageId given, graph::ImageId depth_m,
                                 const gpu::Camera& camera, uint32_t capacity) {
    const Extent2D extent = frame.common_extent({given, depth_m});
    auto count = frame.compute("segmentation.count_given", spirv::count_given);
    count.read("given", given).read("depth_m", depth_m);
    count.push(gpu::CountGivenParams{{extent.width, extent.height}, row_words_of(extent), kGivenIds});
    const graph::BufferId pixels = count.modify("Pixels", add_empty_keys(frame, "segmentation.pixels", kGivenIds));
    count.dispatch_covering(words_of(extent));
    return add_number_segments(frame, pixels, given, depth_m, camera, 1, capacity);
}

}  // namespace patina
