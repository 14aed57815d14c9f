#include "passes/segmentation/number_segments.h"

#include "engine/core/error.h"
#include "shared/segmentation/number_segments.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

constexpr uint64_t kGroupBytes = gpu::kKeysPerGroup * sizeof(uint32_t);

}  // namespace

graph::BufferId add_empty_keys(graph::FrameGraph& frame, const std::string& name, uint32_t keys) {
    const uint64_t groups = (uint64_t{keys} + gpu::kKeysPerGroup - 1) / gpu::kKeysPerGroup;
    return frame.fill(frame.create_buffer(name, groups * kGroupBytes), 0);
}

FrameSegments add_number_segments(graph::FrameGraph& frame, graph::BufferId pixels, graph::ImageId key,
                                  graph::ImageId depth_m, uint32_t min_pixels, uint32_t capacity, uint32_t stride) {
    if (min_pixels == 0) throw Error("the least size of a segment is 0 px, it must be 1 at least");
    if (capacity == 0 || capacity > gpu::kMaxFrameSegments) {
        throw Error("a frame's table of segments for ", capacity, " is asked for, it must be 1 to ",
                    gpu::kMaxFrameSegments);
    }
    const Extent2D extent = frame.common_extent({key, depth_m});
    const auto groups = static_cast<uint32_t>(frame.bytes(pixels) / kGroupBytes);
    const uint32_t area = stride * stride, least = (min_pixels + area - 1) / area;
    const gpu::NumberSegmentsParams params{least, capacity, groups, 0};
    auto total = frame.compute("segmentation.total_segments", spirv::total_segments);
    total.read("Pixels", pixels).push(params);
    const graph::BufferId totals = total.create("Totals", groups * sizeof(gpu::KeyTotals));
    total.dispatch(groups);

    FrameSegments out;
    out.stride = stride;
    const uint64_t table_bytes = (uint64_t{capacity} + 1) * sizeof(gpu::FrameSegment);
    out.segments = frame.fill(frame.create_buffer("segmentation.segments", table_bytes), 0);
    auto number = frame.compute("segmentation.number_segments", spirv::number_segments);
    number.read("Pixels", pixels).read("Totals", totals).push(params);
    const graph::BufferId numbers = number.create("Numbers", frame.bytes(pixels));
    out.segments = number.modify("Segments", out.segments);
    out.count = number.create("Count", sizeof(gpu::FrameSegmentCount));
    number.dispatch(groups);

    auto measure = frame.compute("segmentation.measure_segments", spirv::measure_segments);
    measure.read("keys", key).read("depth_m", depth_m).read("Pixels", pixels).read("Numbers", numbers);
    out.segments = measure.modify("Segments", out.segments);
    out.segment = measure.create("segment", {extent, vulkan::Format::kR32u});
    const auto keys = static_cast<uint32_t>(frame.bytes(pixels) / sizeof(uint32_t));
    measure.push(
        gpu::MeasureSegmentsParams{{extent.width, extent.height}, row_words_of(extent), keys, least, area, 0, 0});
    measure.dispatch_covering(words_of(extent));
    return out;
}

}  // namespace patina
