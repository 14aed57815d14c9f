#include "passes/segmentation/label_pixels.h"

#include "passes/segmentation/sample_labels.h"
#include "shared/segmentation/segments.h"
#include "spirv/shaders.h"

namespace patina {

graph::ImageId add_label_pixels(graph::FrameGraph& frame, const FrameSegments& segments, graph::ImageId map_label,
                                graph::BufferId parents, graph::BufferId segment_labels, Extent2D extent) {
    check_sampled("segmentation.label_pixels", "labels of the map", extent, frame.shape(map_label).extent,
                  gpu::kSampleStride);
    check_sampled("segmentation.label_pixels", "segments", extent, frame.shape(segments.segment).extent,
                  segments.stride);
    auto pass = frame.compute("segmentation.label_pixels", spirv::label_pixels);
    pass.read("segment", segments.segment).read("map_label", map_label);
    pass.read("Parents", parents).read("SegmentLabels", segment_labels);
    const graph::ImageId label = pass.create("label", {extent, vulkan::Format::kR32u});
    pass.specialise("kSegmentStride", segments.stride);
    pass.dispatch_covering(sampled_extent(extent, gpu::kSampleStride));
    return label;
}

}  // namespace patina
