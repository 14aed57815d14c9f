#include "passes/reflectance/find_visibility.h"

#include "spirv/shaders.h"

namespace patina {

void add_find_visibility(graph::FrameGraph& frame, ReflectanceFrame& reflectance, DueRecords& due) {
    const bool texel = reflectance.access.voxels == MapAccess::kTexel;
    auto pass =
        frame.compute("reflectance.find_visibility", texel ? spirv::find_visibility_texel : spirv::find_visibility);
    pass.read("Lights", reflectance.lights).read("Records", reflectance.records.records);
    pass.read("Surroundings", reflectance.state.surroundings);
    pass.read("March", due.march.list).push(reflectance.params);
    const VoxelMapIds& voxels = reflectance.voxels;
    pass.read("Keys", voxels.keys).read("Blocks", voxels.blocks).read("Tsdf", voxels.tsdf);
    pass.specialise("kVoxelChunks", reflectance.voxel_map.chunks());
    pass.specialise("kGathers", reflectance.gathered_rays > 0 ? 1u : 0u);
    reflectance.state.status = pass.modify("Status", reflectance.state.status);
    reflectance.records.visibility = pass.modify("Visibility", reflectance.records.visibility);
    due.refine.list = pass.modify("Refine", due.refine.list);
    due.refine.arguments = pass.modify("RefineArguments", due.refine.arguments);
    pass.dispatch_indirect(due.march.arguments);
}

}  // namespace patina
