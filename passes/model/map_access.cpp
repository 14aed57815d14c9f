#include "passes/model/map_access.h"

#include <algorithm>

namespace patina {

MapAccess preferred_map_access(const vulkan::DeviceCaps& caps, const VoxelMap& map) {
    const uint64_t chunk_voxels = (uint64_t{1} << map.grid().chunk_shift) * gpu::kBlockVoxels;
    const uint64_t largest = std::max<uint64_t>(chunk_voxels, map.table_slots());
    return caps.software() && largest <= caps.max_texel_elements ? MapAccess::kTexel : MapAccess::kStorage;
}

}  // namespace patina
