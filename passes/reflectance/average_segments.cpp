#include "passes/reflectance/average_segments.h"

#include <algorithm>

#include "spirv/shaders.h"

namespace patina {

namespace {

// The dispatch covers the pool, used or not, and software devices run a group that finds nothing at nearly full cost.
constexpr uint32_t kRecordsPerItem = 8;

graph::BufferId start_sums(graph::FrameGraph& frame, uint32_t labels, std::optional<graph::BufferId> away) {
    const uint64_t bytes = labels * sizeof(gpu::SegmentAlbedo);
    if (!away) return frame.fill(frame.create_buffer("reflectance.segments", bytes), 0);
    auto start = frame.compute("reflectance.start_segments", spirv::start_segments);
    const graph::BufferId sums = start.read("Away", *away).create("Segments", bytes);
    start.dispatch_covering(labels);
    return sums;
}

}  // namespace

graph::BufferId add_average_segments(graph::FrameGraph& frame, const ObservationMap& map,
                                     const ObservationMapIds& records, uint32_t labels,
                                     std::optional<graph::BufferId> away) {
    const graph::BufferId sums = start_sums(frame, labels, away);
    auto pass = frame.compute("reflectance.average_segments", spirv::average_segments);
    pass.read("RecordCounters", records.record_counters).read("Records", records.records);
    pass.read("Albedo", records.albedo);
    const graph::BufferId averaged = pass.modify("Segments", sums);
    pass.specialise("kRecordsPerItem", kRecordsPerItem);
    pass.dispatch_covering((map.capacity_records() + kRecordsPerItem - 1) / kRecordsPerItem);
    return averaged;
}

std::optional<glm::vec3> kd_of(const gpu::SegmentAlbedo& segment) {
    const glm::vec3 weight(segment.weight);
    if (std::min({weight.r, weight.g, weight.b}) < gpu::kLeastSegmentWeight * gpu::kCertaintySteps) return std::nullopt;
    return glm::vec3(segment.kd) / (weight * gpu::kAlbedoSteps);
}

}  // namespace patina
