#pragma once

#include "engine/graph/frame.h"
#include "engine/vulkan/device.h"
#include "passes/model/voxel_map.h"

namespace patina {

/// A label per voxel of a voxel map, beside it: block ids and chunks are the map's. A voxel holds label 16 bits |
/// confidence 6 bits, 0 where none is known. Blocks are cleared when the map assigns them
/// (segmentation/clear_labels.h), so that nothing has to be done when they are removed.
class LabelMap {
  public:
    /// Throws Error when memory runs out.
    LabelMap(vulkan::Device& device, const VoxelMap& map);

    graph::BufferId import(graph::Frame& frame) const { return frame.import(labels_); }
    uint64_t bytes() const { return labels_.bytes(); }

  private:
    vulkan::ChunkedBuffer labels_;
};

}  // namespace patina
