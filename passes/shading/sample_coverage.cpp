#include "passes/shading/sample_coverage.h"

#include "shared/shading/sample_coverage.h"
#include "spirv/shaders.h"

namespace patina {

graph::ImageId add_sample_coverage(graph::FrameGraph& frame, const ObservationMap& map,
                                   const ObservationMapIds& records, const SampleCoverageInputs& inputs) {
    const Extent2D extent = frame.shape(inputs.position_m).extent;
    auto pass = frame.compute("shading.sample_coverage", spirv::sample_coverage);
    pass.read("position_m", inputs.position_m).read("View", inputs.view).read("ViewGrid", inputs.view_grid);
    pass.read("Entries", inputs.packed.entries).read("Packed", inputs.packed.content);
    pass.read("Records", records.records);
    const graph::ImageId coverage = pass.create("coverage", {extent, vulkan::Format::kRgba16f});
    pass.push(gpu::SampleCoverageParams{map.settings().voxel_m, map.edge_shift(), 0, 0});
    pass.dispatch_covering(extent);
    return coverage;
}

}  // namespace patina
