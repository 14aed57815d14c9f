#include "passes/shading/pack_records.h"

#include "spirv/shaders.h"

namespace patina {

namespace {

// The dispatch covers the pool, used or not, and software devices run a group that finds nothing at nearly full cost.
constexpr uint32_t kRecordsPerItem = 8;

}  // namespace

graph::BufferId add_pack_records(graph::FrameGraph& frame, const ObservationMap& map, const ObservationMapIds& records,
                                 const ReflectanceStateIds& state) {
    const uint32_t capacity = map.capacity_records();
    auto pass = frame.compute("shading.pack_records", spirv::pack_records);
    pass.read("RecordCounters", records.record_counters).read("Status", state.status);
    pass.read("Records", records.records).read("Albedo", records.albedo).read("Visibility", records.visibility);
    const graph::BufferId packed = pass.create("Packed", uint64_t{capacity} * sizeof(glm::uvec4));
    pass.specialise("kRecordsPerItem", kRecordsPerItem);
    pass.dispatch_covering((capacity + kRecordsPerItem - 1) / kRecordsPerItem);
    return packed;
}

}  // namespace patina
