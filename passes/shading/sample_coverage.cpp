#include "passes/shading/sample_coverage.h"

#include "shared/shading/sample_coverage.h"
#include "spirv/shaders.h"

namespace patina {

graph::ImageId add_sample_coverage(graph::FrameGraph& frame, const ObservationMap& map,
                                   const ObservationMapIds& records, const VisibleBlocks& visible,
                                   const PackedRecords& packed, graph::ImageId position_m) {
    const Extent2D extent = frame.shape(position_m).extent;
    auto pass = frame.compute("shading.sample_coverage", spirv::sample_coverage);
    pass.read("position_m", position_m).read("View", visible.view).read("ViewGrid", visible.grid);
    pass.read("Entries", packed.entries).read("Packed", packed.content).read("Records", records.records);
    const graph::ImageId coverage = pass.create("coverage", {extent, vulkan::Format::kRgba16f});
    pass.push(gpu::SampleCoverageParams{map.settings().voxel_m, map.edge_shift(), 0, 0});
    pass.dispatch_covering(extent);
    return coverage;
}

}  // namespace patina
