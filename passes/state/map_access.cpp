#include "passes/state/map_access.h"

#include <algorithm>

#include "engine/vulkan/floor.h"

namespace patina {

namespace {

MapAccess preferred(const vulkan::DeviceCaps& caps, uint64_t most_elements) {
    const bool texels = caps.software() && caps.max_storage_images >= vulkan::floor::kTexelVariantImages &&
                        most_elements <= caps.max_texel_elements;
    return texels ? MapAccess::kTexel : MapAccess::kStorage;
}

}  // namespace

MapAccess preferred_map_access(const vulkan::DeviceCaps& caps, const VoxelMap& map) {
    const uint64_t chunk_voxels = (uint64_t{1} << map.grid().chunk_shift) * gpu::kBlockVoxels;
    return preferred(caps, std::max<uint64_t>(chunk_voxels, map.table_slots()));
}

MapAccess preferred_map_access(const vulkan::DeviceCaps& caps, const ObservationMap& map) {
    return preferred(caps, uint64_t{map.chunk_records()} * gpu::kRecordQuads);
}

}  // namespace patina
