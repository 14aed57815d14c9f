#include "passes/reflectance/smooth_irradiance.h"

#include "spirv/shaders.h"

namespace patina {

void add_smooth_irradiance(graph::FrameGraph& frame, ReflectanceFrame& reflectance, const RecordList& march) {
    auto pass = frame.compute("reflectance.smooth_irradiance", spirv::smooth_irradiance);
    const ObservationMapIds& ids = reflectance.records;
    pass.read("Keys", ids.keys).read("Blocks", ids.blocks).read("RecordTable", ids.record_table);
    pass.read("Records", ids.records)
        .read("March", march.list)
        .read("Gathered", reflectance.state.gathered)
        .push(reflectance.params);
    reflectance.state.status = pass.modify("Status", reflectance.state.status);
    pass.dispatch_indirect(march.arguments);
}

}  // namespace patina
