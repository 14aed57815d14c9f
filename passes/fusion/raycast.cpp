#include "passes/fusion/raycast.h"

#include <algorithm>

#include "shared/raycast.h"
#include "spirv/shaders.h"

namespace patina {

MapAccess preferred_map_access(const vulkan::DeviceCaps& caps, const VoxelMap& map) {
    const uint64_t chunk_voxels = (uint64_t{1} << map.grid().chunk_shift) * gpu::kBlockVoxels;
    const uint64_t largest = std::max<uint64_t>(chunk_voxels, map.table_slots());
    return caps.software() && largest <= caps.max_texel_elements ? MapAccess::kTexel : MapAccess::kStorage;
}

RaycastImages add_raycast(graph::Frame& frame, const VoxelMap& map, const VoxelMapIds& ids,
                          const VisibleBlocks& visible, MapAccess access) {
    auto pass = frame.compute("fusion.raycast", access == MapAccess::kTexel ? spirv::raycast_texel : spirv::raycast);
    pass.read("View", visible.view).read("Tiles", visible.tiles);
    pass.read("Keys", ids.keys).read("Blocks", ids.blocks).read("Tsdf", ids.tsdf);
    pass.specialise("kVoxelChunks", map.chunks());
    RaycastImages out;
    out.position_m = pass.create("position_m", {visible.extent, vulkan::Format::kRgba32f});
    out.normal = pass.create("normal", {visible.extent, vulkan::Format::kRgba16f});
    pass.dispatch_covering(visible.extent);
    return out;
}

}  // namespace patina
