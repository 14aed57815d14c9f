#include "passes/shading/sample_reflectance.h"

#include "spirv/shaders.h"

namespace patina {

graph::BufferId add_sample_reflectance(graph::FrameGraph& frame, const ObservationMap& map,
                                       const ObservationMapIds& records, const SampleReflectanceInputs& inputs) {
    auto pass = frame.compute("shading.sample_reflectance", spirv::sample_reflectance);
    pass.read("Keys", records.keys).read("Blocks", records.blocks).read("RecordTable", records.record_table);
    pass.read("Packed", inputs.packed).read("Records", records.records).read("Segments", inputs.segments);
    pass.read("Gathered", inputs.gathered);
    pass.read("Positions", inputs.positions_m).read("Normals", inputs.normals);
    const graph::BufferId samples = pass.create("Samples", uint64_t{inputs.points} * sizeof(gpu::SampledReflectance));
    pass.push(gpu::SampleReflectanceParams{map.grid(), map.edge_shift(), inputs.points, inputs.material_count, 0});
    pass.dispatch_covering(inputs.points);
    return samples;
}

}  // namespace patina
