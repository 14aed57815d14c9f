#pragma once

#include "engine/graph/frame.h"
#include "passes/fusion/raycast.h"
#include "passes/fusion/visible_blocks.h"
#include "passes/model/voxel_map.h"

namespace patina {

/// The voxels that a frame's pixels see.
struct ClaimedVoxels {
    graph::ImageId label;   ///< W x H r32ui: root of the voxel's label; 0 where there is none
    graph::ImageId voxel;   ///< W x H r32ui: block id * gpu::kBlockVoxels + number within it, or gpu::kNoVoxel
    graph::BufferId words;  ///< LabelMap, in which each voxel seen carries the tag of the pixel that speaks for it
};

/// Finds the voxel that holds each pixel's surface point, and its label in `words` (LabelMap), of which it takes the
/// root in `parents` (SegmentTable). Of the pixels that see one voxel one is chosen, by its place in the picture;
/// update_labels.h goes on with it and must follow. Pixels that see the surface grazingly, or a voxel from so near that
/// it covers more than gpu::kMostVoxelPixels, have no voxel. Throws Error when the images of `model` differ in extent.
ClaimedVoxels add_claim_voxels(graph::Frame& frame, const VoxelMap& map, graph::BufferId words,
                               graph::BufferId parents, const VisibleBlocks& visible, const RaycastImages& model);

}  // namespace patina
