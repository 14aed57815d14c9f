#pragma once

#include <optional>

#include "engine/graph/frame_graph.h"
#include "passes/fusion/visible_blocks.h"
#include "passes/state/voxel_map.h"

namespace patina {

/// Fuses a depth image, and colour where it is given, into the visible blocks: the running average of Curless and Levoy
/// 1996 over the distance from each reading's tangent plane, truncated at t(z) in front of the surface, beside a depth
/// edge at a pixel's width if that is less, and left alone behind it. `params` holds gpu::FusionParams; `depth_m` is W
/// x H r32f (0: no reading), `slope` from add_measure_slope; `color_linear` is the colour camera's rgba16f image (a =
/// 0: no reading), sampled at the nearest pixel through that camera's own intrinsics and pose, by voxels within
/// color_band_m of the surface, in a second pass (fusion.integrate_color) over the blocks that have some; blocks that
/// are settled there take turns (FusionSettings::settled_color_every).
void add_integrate(graph::FrameGraph& frame, const VoxelMap& map, VoxelMapIds& ids, const VisibleBlocks& visible,
                   graph::BufferId params, graph::ImageId depth_m, graph::ImageId slope,
                   std::optional<graph::ImageId> color_linear);

}  // namespace patina
