#include "passes/reflectance/refine_albedo.h"

#include "spirv/shaders.h"

namespace patina {

void add_refine_albedo(graph::FrameGraph& frame, ReflectanceFrame& reflectance, const RecordList& refine) {
    const bool texel = reflectance.access.observations == MapAccess::kTexel;
    auto pass = frame.compute("reflectance.refine_albedo", texel ? spirv::refine_albedo_texel : spirv::refine_albedo);
    ObservationMapIds& ids = reflectance.records;
    pass.read("Lights", reflectance.lights).read("Materials", reflectance.materials).read("Records", ids.records);
    pass.read("Visibility", ids.visibility).read("Refine", refine.list).push(reflectance.params);
    pass.read("Directions", ids.directions).read("Colors", ids.colors);
    pass.specialise("kVoxelChunks", reflectance.map.chunks());
    reflectance.state.status = pass.modify("Status", reflectance.state.status);
    ids.albedo = pass.modify("Albedo", ids.albedo);
    pass.dispatch_indirect(refine.arguments);
}

}  // namespace patina
