#include "passes/reflectance/recolor_surfaces.h"

#include "spirv/shaders.h"

namespace patina {

void add_recolor_surfaces(graph::FrameGraph& frame, const ReflectanceFrame& reflectance, VoxelMapIds& frame_voxels,
                          const RecolorInputs& inputs) {
    auto pass = frame.compute("reflectance.recolor_surfaces", spirv::recolor_surfaces);
    const ObservationMapIds& records = reflectance.records;
    pass.read("Lights", reflectance.lights).read("Materials", reflectance.materials).read("Segments", inputs.segments);
    pass.read("Records", records.records).read("March", inputs.listed.list);
    pass.read("Albedo", records.albedo).read("Visibility", records.visibility);
    pass.read("Status", reflectance.state.status).read("Gathered", reflectance.state.gathered);
    pass.read("Keys", frame_voxels.keys).read("Blocks", frame_voxels.blocks);
    frame_voxels.color = pass.modify("Color", frame_voxels.color);
    pass.specialise("kVoxelChunks", reflectance.voxel_map.chunks()).specialise("kGathers", inputs.gathers ? 1u : 0u);
    pass.push(reflectance.params);
    pass.dispatch_indirect(inputs.listed.arguments);
}

}  // namespace patina
