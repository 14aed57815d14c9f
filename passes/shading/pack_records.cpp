#include "passes/shading/pack_records.h"

#include "spirv/shaders.h"

namespace patina {

graph::BufferId add_pack_records(graph::Frame& frame, const ObservationMap& map, const ObservationMapIds& records,
                                 const ReflectanceStateIds& state) {
    const uint32_t capacity = map.settings().capacity_records;
    auto pass = frame.compute("shading.pack_records", spirv::pack_records);
    pass.read("RecordCounters", records.record_counters).read("Status", state.status);
    pass.read("Records", records.records).read("Albedo", records.albedo).read("Visibility", records.visibility);
    const graph::BufferId packed = pass.create("Packed", uint64_t{capacity} * sizeof(glm::uvec4));
    pass.dispatch_covering(capacity);
    return packed;
}

}  // namespace patina
