#include "passes/segmentation/count_overlaps.h"

#include <algorithm>
#include <bit>

#include "passes/segmentation/sample_labels.h"
#include "spirv/shaders.h"

namespace patina {

uint32_t overlap_slots(Extent2D extent) {
    constexpr size_t kPixelsPerSlot = 16;
    return static_cast<uint32_t>(std::bit_ceil(std::max<size_t>(extent.area() / kPixelsPerSlot, 1024)));
}

SegmentOverlaps add_count_overlaps(graph::FrameGraph& frame, SegmentTableIds& table, const FrameSegments& segments,
                                   graph::ImageId map_label, graph::ImageId position_m, graph::ImageId color_linear,
                                   graph::BufferId params) {
    const Extent2D extent = frame.shape(position_m).extent;
    const Extent2D sampled = frame.shape(map_label).extent;
    check_sampled("segmentation.count_overlaps", "labels of the map", extent, sampled, gpu::kSampleStride);
    check_sampled("segmentation.count_overlaps", "segments", extent, frame.shape(segments.segment).extent,
                  segments.stride);
    const uint32_t slots = overlap_slots(extent);
    SegmentOverlaps out;
    out.table = frame.fill(frame.create_buffer("segmentation.overlaps", slots * sizeof(gpu::SegmentOverlap)), 0);
    out.list = frame.fill(frame.create_buffer("segmentation.overlap_list", (1 + slots) * sizeof(uint32_t)), 0, 4);
    auto pass = frame.compute("segmentation.count_overlaps", spirv::count_overlaps);
    pass.read("segment", segments.segment).read("map_label", map_label).read("position_m", position_m);
    pass.read("color_linear", color_linear).read("Segmentation", params);
    out.table = pass.modify("Overlaps", out.table);
    out.list = pass.modify("OverlapList", out.list);
    table.labels = pass.modify("Labels", table.labels);
    pass.specialise("kSegmentStride", segments.stride);
    const uint32_t strips = (sampled.width + gpu::kStripPixels - 1) / gpu::kStripPixels;
    pass.dispatch_covering(Extent2D{strips, sampled.height});
    return out;
}

}  // namespace patina
