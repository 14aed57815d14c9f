#pragma once

#include "engine/graph/frame.h"
#include "passes/model/label_map.h"
#include "passes/segmentation/surface_view.h"

namespace patina {

/// Lists the blocks that hold points of the surface and were
/// never listed since they were assigned, or have their turn: one in gpu::kUpdateFrames frames, by their keys. `stamp`
/// is the frame's index + 1.
SurfaceBlocks add_list_surface(graph::Frame& frame, const VoxelMap& map, LabelMapIds& labels,
                               const SurfaceView& surface, uint32_t stamp);

}  // namespace patina
