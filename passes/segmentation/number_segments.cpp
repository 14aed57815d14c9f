#include "passes/segmentation/number_segments.h"

#include "engine/core/error.h"
#include "shared/number_segments.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

constexpr uint64_t kGroupBytes = gpu::kKeysPerGroup * sizeof(uint32_t);

}  // namespace

graph::BufferId add_empty_keys(graph::Frame& frame, const std::string& name, uint32_t keys) {
    const uint64_t groups = (uint64_t{keys} + gpu::kKeysPerGroup - 1) / gpu::kKeysPerGroup;
    return frame.fill(frame.create_buffer(name, groups * kGroupBytes), 0);
}

NumberedSegments add_number_segments(graph::Frame& frame, graph::BufferId pixels, uint32_t min_pixels,
                                     uint32_t capacity) {
    if (min_pixels == 0) throw Error("the least size of a segment is 0 px, it must be 1 at least");
    if (capacity == 0 || capacity > gpu::kMaxFrameSegments) {
        throw Error("a frame's table of segments for ", capacity, " is asked for, it must be 1 to ",
                    gpu::kMaxFrameSegments);
    }
    const auto groups = static_cast<uint32_t>(frame.bytes(pixels) / kGroupBytes);
    const gpu::NumberSegmentsParams params{min_pixels, capacity, groups, 0};
    auto total = frame.compute("segmentation.total_segments", spirv::total_segments);
    total.read("Pixels", pixels).push(params);
    const graph::BufferId totals = total.create("Totals", groups * sizeof(gpu::KeyTotals));
    total.dispatch(groups);

    NumberedSegments out;
    out.segments =
        frame.fill(frame.create_buffer("segmentation.segments", (capacity + 1) * sizeof(gpu::FrameSegment)), 0);
    auto number = frame.compute("segmentation.number_segments", spirv::number_segments);
    number.read("Pixels", pixels).read("Totals", totals).push(params);
    out.numbers = number.create("Numbers", frame.bytes(pixels));
    out.segments = number.modify("Segments", out.segments);
    out.count = number.create("Count", sizeof(gpu::FrameSegmentCount));
    number.dispatch(groups);
    return out;
}

}  // namespace patina
