#include "passes/reflectance/gather_irradiance.h"

#include "spirv/shaders.h"

namespace patina {

void add_gather_irradiance(graph::FrameGraph& frame, ReflectanceFrame& reflectance, const RecordList& march,
                           bool forgets) {
    const bool texel = reflectance.access.voxels == MapAccess::kTexel;
    auto pass = frame.compute("reflectance.gather_irradiance",
                              texel ? spirv::gather_irradiance_texel : spirv::gather_irradiance);
    const VoxelMapIds& voxels = reflectance.voxels;
    pass.read("Surroundings", reflectance.state.surroundings)
        .read("Lights", reflectance.lights)
        .read("Records", reflectance.records.records)
        .read("March", march.list);
    pass.read("Keys", voxels.keys).read("Blocks", voxels.blocks).read("Tsdf", voxels.tsdf).read("Color", voxels.color);
    pass.specialise("kVoxelChunks", reflectance.voxel_map.chunks()).specialise("kRays", reflectance.gathered_rays);
    pass.specialise("kForgets", forgets ? 1u : 0u).push(reflectance.params);
    reflectance.state.gathered = pass.modify("Gathered", reflectance.state.gathered);
    pass.dispatch_indirect(march.arguments);
}

}  // namespace patina
