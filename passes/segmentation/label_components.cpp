#include "passes/segmentation/label_components.h"

#include "passes/segmentation/number_segments.h"
#include "shared/segmentation/label_components.h"
#include "spirv/shaders.h"

namespace patina {

Components add_label_components(graph::FrameGraph& frame, graph::ImageId inner_depth_m, float jump_m,
                                float jump_slope) {
    const Extent2D extent = frame.shape(inner_depth_m).extent;
    const uint32_t pixels = extent.width * extent.height, words = words_of(extent);
    const gpu::LabelComponentsParams params{
        {extent.width, extent.height}, row_words_of(extent), jump_m, jump_slope, 0, 0, 0};

    auto label = frame.compute("segmentation.label_runs", spirv::label_runs);
    label.read("inner_depth_m", inner_depth_m).push(params);
    const graph::BufferId runs = label.create("Words", words * sizeof(gpu::RunWord));
    graph::BufferId parents = label.create("Parents", pixels * sizeof(uint32_t));
    label.dispatch_covering(words);

    auto join = frame.compute("segmentation.join_runs", spirv::join_runs);
    join.read("Words", runs).push(params);
    parents = join.modify("Parents", parents);
    join.dispatch_covering(words);

    Components components;
    auto count = frame.compute("segmentation.count_components", spirv::count_components);
    count.read("Words", runs).push(params);
    components.parents = count.modify("Parents", parents);
    components.pixels = count.modify("Pixels", add_empty_keys(frame, "segmentation.pixels", pixels + 1));
    components.component = count.create("component", {extent, vulkan::Format::kR32u});
    count.dispatch_covering(words);
    return components;
}

}  // namespace patina
