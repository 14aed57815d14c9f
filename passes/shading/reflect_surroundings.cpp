#include "passes/shading/reflect_surroundings.h"

#include "shared/shading/reflect_surroundings.h"
#include "spirv/shaders.h"

namespace patina {

graph::ImageId add_reflect_surroundings(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& voxels,
                                        const ReflectSurroundingsInputs& inputs) {
    const Extent2D extent = frame.common_extent({inputs.position_m, inputs.normal, inputs.rgb});
    const bool texel = inputs.access == MapAccess::kTexel;
    auto pass = frame.compute("shading.reflect_surroundings",
                              texel ? spirv::reflect_surroundings_texel : spirv::reflect_surroundings);
    pass.read("position_m", inputs.position_m).read("normal", inputs.normal).read("rgb", inputs.rgb);
    pass.read("Glossy", inputs.glossy).read("Surroundings", inputs.surroundings).read("Lights", inputs.lights);
    pass.read("Keys", voxels.keys).read("Blocks", voxels.blocks).read("Tsdf", voxels.tsdf).read("Color", voxels.color);
    pass.specialise("kVoxelChunks", map.chunks()).specialise("kRays", inputs.rays);
    const graph::ImageId rgb = pass.create("reflecting_rgb", {extent, vulkan::Format::kRgba16f});
    pass.push(gpu::ReflectParams{map.grid(), inputs.ball_m});
    pass.dispatch_covering(extent);
    return rgb;
}

}  // namespace patina
