#include "passes/reflectance/mark_blocks.h"

#include "spirv/shaders.h"

namespace patina {

void add_mark_blocks(graph::FrameGraph& frame, ReflectanceStateIds& state, const VoxelMap& map,
                     const VoxelMapIds& voxels) {
    auto pass = frame.compute("reflectance.mark_blocks", spirv::mark_blocks);
    pass.read("BlockKeys", voxels.block_keys).read("Counters", voxels.counters);
    state.surroundings = pass.modify("Surroundings", state.surroundings);
    pass.push(map.grid());
    pass.dispatch_indirect(voxels.block_arguments);
}

}  // namespace patina
