#include "passes/reflectance/mark_regions.h"

#include "spirv/shaders.h"

namespace patina {

void add_mark_regions(graph::FrameGraph& frame, ReflectanceStateIds& state, const VoxelMap& map,
                      const VoxelMapIds& voxels) {
    auto pass = frame.compute("reflectance.mark_regions", spirv::mark_regions);
    pass.read("BlockKeys", voxels.block_keys).read("Counters", voxels.counters);
    state.surroundings = pass.modify("Surroundings", state.surroundings);
    pass.push(map.grid());
    pass.dispatch_indirect(voxels.block_arguments);
}

}  // namespace patina
