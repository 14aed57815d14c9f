#pragma once

#include "engine/graph/frame_graph.h"
#include "engine/graph/state_visitor.h"
#include "engine/vulkan/device.h"
#include "passes/state/voxel_map.h"

namespace patina {

/// Versions of the labels' buffers within one frame; passes that write replace the ids.
struct LabelMapIds {
    graph::BufferId words;   ///< u32 per voxel, chunked: label 16 bits, 0 where none is known | confidence 8 bits
    graph::BufferId stamps;  ///< u32 per block: index + 1 of the frame that updated it last, and
                             ///< gpu::kSettledBlock if its labels have settled, gpu::kRestlessBlock if voxels near
                             ///< the surface had none or were contradicted; 0: never
};

/// A label per voxel of a voxel map, beside it: block ids and chunks are the map's. Blocks are cleared when the map
/// assigns them (segmentation/clear_labels.h), so that nothing has to be done when they are removed.
class LabelMap {
  public:
    /// Throws Error when memory runs out.
    LabelMap(vulkan::Device& device, const VoxelMap& map);

    /// Announces that the map's pool grows to `blocks`.
    void enlarge(graph::Enlargement& enlargement, uint32_t blocks);

    LabelMapIds import(graph::FrameGraph& frame) const { return {frame.import(words_), frame.import(stamps_)}; }
    static void keep(graph::FrameGraph& frame, const LabelMapIds& ids);

    void visit(graph::StateVisitor& visitor);

    uint64_t bytes() const { return words_.bytes() + stamps_->bytes(); }

  private:
    vulkan::ChunkedBuffer words_;
    vulkan::BufferRef stamps_;
};

}  // namespace patina
