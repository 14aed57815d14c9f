#include "passes/segmentation/label_components.h"

#include "passes/segmentation/number_segments.h"
#include "shared/label_components.h"
#include "spirv/shaders.h"

namespace patina {

Components add_label_components(graph::Frame& frame, graph::ImageId inner_depth_m, const ConnectionLimit& limit) {
    Components components;
    components.extent = frame.shape(inner_depth_m).extent;
    const auto [width, height] = components.extent;
    const uint32_t pixels = width * height, words = words_of(components.extent);
    const gpu::LabelComponentsParams params{{width, height}, (width + 31) / 32, limit.floor_m, limit.relative, 0, 0, 0};

    auto label = frame.compute("segmentation.label_runs", spirv::label_runs);
    label.read("inner_depth_m", inner_depth_m).push(params);
    components.words = label.create("Words", words * sizeof(gpu::RunWord));
    components.parents = label.create("Parents", pixels * sizeof(uint32_t));
    label.dispatch_covering(words);

    auto join = frame.compute("segmentation.join_runs", spirv::join_runs);
    join.read("Words", components.words).push(params);
    components.parents = join.modify("Parents", components.parents);
    join.dispatch_covering(words);

    components.pixels = add_empty_keys(frame, "segmentation.pixels", pixels);
    auto count = frame.compute("segmentation.count_components", spirv::count_components);
    count.read("Words", components.words).push(params);
    components.parents = count.modify("Parents", components.parents);
    components.pixels = count.modify("Pixels", components.pixels);
    count.dispatch_covering(words);
    return components;
}

}  // namespace patina
