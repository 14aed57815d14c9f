#include "passes/state/label_map.h"

namespace patina {

LabelMap::LabelMap(vulkan::Device& device, const VoxelMap& map)
    : words_(device, "map.labels", map.capacity(), gpu::kBlockVoxels * sizeof(uint32_t),
             uint64_t{1} << map.grid().chunk_shift, gpu::kMaxVoxelChunks),
      stamps_(device.create_buffer({"map.label_stamps", map.capacity() * sizeof(uint32_t)})) {}

void LabelMap::enlarge(graph::Enlargement& enlargement, uint32_t blocks) {
    enlargement.add(words_, blocks);
    enlargement.add(stamps_, blocks * sizeof(uint32_t));
}

void LabelMap::keep(graph::FrameGraph& frame, const LabelMapIds& ids) {
    frame.keep(ids.words);
    frame.keep(ids.stamps);
}

void LabelMap::visit(graph::StateVisitor& visitor) {
    visitor.array(words_);
    visitor.buffer(stamps_);
}

}  // namespace patina
