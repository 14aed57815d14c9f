#pragma once

#include "passes/fusion/raycast.h"
#include "passes/fusion/visible_blocks.h"
#include "passes/input/input.h"
#include "reconstruction/frame_context.h"
#include "reconstruction/growing_pools.h"
#include "reconstruction/stages/stages.h"

namespace patina {

/// A frame's counters, as they arrive.
struct FrameReadbacks {
    PoolReadbacks pools;
    graph::Readback visible_blocks;  ///< u32: their count
};

/// Declares all that is done with one frame, at its pose: preprocess, allocate, integrate, raycast, segment, observe,
/// refine. `pictures` are the frame's, converted. Replaces what the stages hold between frames.
FrameReadbacks wire_frame(graph::FrameGraph& graph, Stages& stages, const FrameContext& frame,
                          const InputPictures& pictures);

/// Keeps the model as `camera` sees it as what the next frames are tracked against: `cast` and `visible` are that view.
/// Needs tracking.
void wire_reference(graph::FrameGraph& graph, Stages& stages, const VoxelMapIds& voxels, const VisibleBlocks& visible,
                    const RaycastImages& cast, const PosedCamera& camera);

}  // namespace patina
