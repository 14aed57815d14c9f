#include "passes/model/map_access.h"

#include <algorithm>

namespace patina {

namespace {

MapAccess preferred(const vulkan::DeviceCaps& caps, uint64_t most_elements) {
    return caps.software() && most_elements <= caps.max_texel_elements ? MapAccess::kTexel : MapAccess::kStorage;
}

}  // namespace

MapAccess preferred_map_access(const vulkan::DeviceCaps& caps, const VoxelMap& map) {
    const uint64_t chunk_voxels = (uint64_t{1} << map.grid().chunk_shift) * gpu::kBlockVoxels;
    return preferred(caps, std::max<uint64_t>(chunk_voxels, map.table_slots()));
}

MapAccess preferred_map_access(const vulkan::DeviceCaps& caps, const ObservationMap& map) {
    const uint64_t records = std::min(uint64_t{1} << map.grid().chunk_shift, uint64_t{map.settings().capacity_records});
    return preferred(caps, records * gpu::kRecordQuads);
}

}  // namespace patina
