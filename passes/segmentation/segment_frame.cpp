#include "passes/segmentation/segment_frame.h"

#include "passes/segmentation/label_components.h"
#include "passes/segmentation/number_segments.h"
#include "shared/segmentation/number_segments.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

constexpr uint32_t kGivenIds = 65536;

}  // namespace

FrameSegments add_segment_frame(graph::FrameGraph& frame, graph::ImageId model_position_m, graph::ImageId reading_m,
                                const gpu::Camera& camera, const ColorPicture& color, const SegmentSettings& settings) {
    const uint32_t stride = settings.stride_px;
    const gpu::FrameSurfaceParams params = make_surface_params(camera, settings.edges, settings.min_pixels, stride);
    const FrameSurface surface = add_choose_depth(frame, model_position_m, reading_m, camera, color, stride);
    const graph::ImageId normal = add_fit_normals(frame, surface.depth_m, params);
    const graph::ImageId inner_depth_m = add_find_edges(frame, surface, normal, params);
    const auto [component, pixels, parents] =
        add_label_components(frame, inner_depth_m, params.jump_m, params.jump_slope);
    const ClaimedEdges claimed = add_claim_edges(frame, component, pixels, surface, normal, params);
    const graph::BufferId joined = add_join_folds(frame, claimed.contacts, parents, pixels, settings.folds);
    return add_number_segments(frame, joined, claimed.component, surface.depth_m, settings.min_pixels,
                               settings.capacity, stride);
}

FrameSegments add_given_segments(graph::FrameGraph& frame, graph::ImageId given, graph::ImageId depth_m,
                                 uint32_t capacity) {
    const Extent2D extent = frame.common_extent({given, depth_m});
    auto count = frame.compute("segmentation.count_given", spirv::count_given);
    count.read("given", given).read("depth_m", depth_m);
    count.push(gpu::CountGivenParams{{extent.width, extent.height}, row_words_of(extent), kGivenIds});
    const graph::BufferId pixels = count.modify("Pixels", add_empty_keys(frame, "segmentation.pixels", kGivenIds));
    count.dispatch_covering(words_of(extent));
    return add_number_segments(frame, pixels, given, depth_m, 1, capacity);
}

}  // namespace patina
