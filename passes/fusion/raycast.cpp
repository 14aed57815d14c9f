#include "passes/fusion/raycast.h"

#include <algorithm>

#include "shared/fusion/raycast.h"
#include "spirv/shaders.h"

namespace patina {

RaycastImages add_raycast(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& ids,
                          const VisibleBlocks& visible, MapAccess access) {
    auto pass = frame.compute("fusion.raycast", access == MapAccess::kTexel ? spirv::raycast_texel : spirv::raycast);
    pass.read("View", visible.view).read("Tiles", visible.tiles);
    pass.read("ViewGrid", visible.grid).read("Tsdf", ids.tsdf);
    pass.specialise("kVoxelChunks", map.chunks());
    RaycastImages out;
    out.position_m = pass.create("position_m", {visible.extent, vulkan::Format::kRgba32f});
    out.normal = pass.create("normal", {visible.extent, vulkan::Format::kRgba16f});
    pass.dispatch_covering(visible.extent);
    return out;
}

}  // namespace patina
