#include "passes/model/label_map.h"

namespace patina {

LabelMap::LabelMap(vulkan::Device& device, const VoxelMap& map)
    : labels_(device, "map.labels", map.settings().capacity_blocks, gpu::kBlockVoxels * sizeof(uint32_t),
              uint64_t{1} << map.grid().chunk_shift, gpu::kMaxVoxelChunks) {}

}  // namespace patina
