#include "passes/segmentation/claim_voxels.h"

#include "spirv/shaders.h"

namespace patina {

ClaimedVoxels add_claim_voxels(graph::Frame& frame, const VoxelMap& map, graph::BufferId words,
                               graph::BufferId parents, const VisibleBlocks& visible, const RaycastImages& model) {
    const Extent2D extent = frame.common_extent({model.position_m, model.normal});
    auto pass = frame.compute("segmentation.claim_voxels", spirv::claim_voxels);
    pass.read("position_m", model.position_m).read("normal", model.normal);
    pass.read("View", visible.view).read("ViewGrid", visible.grid).read("Parents", parents);
    pass.specialise("kVoxelChunks", map.chunks());
    ClaimedVoxels out;
    out.label = pass.create("map_label", {extent, vulkan::Format::kR32u});
    out.voxel = pass.create("voxel", {extent, vulkan::Format::kR32u});
    out.words = pass.modify("Words", words);
    pass.dispatch_covering(extent);
    return out;
}

}  // namespace patina
