#pragma once

#include <algorithm>
#include <optional>

#include "engine/graph/frame_graph.h"
#include "passes/state/voxel_map.h"
#include "shared/fusion/allocate_blocks.h"

namespace patina {

/// How depth and colour are fused.
struct FusionSettings {
    float truncation_m = 0.02f;       ///< t(z) = truncation_m + truncation_slope * z, at least 3 voxels
    float truncation_slope = 0.005f;  ///< grows with the sensor's noise
    float max_depth_m = 8.0f;         ///< farther readings are not fused
    uint32_t max_weight = 6;          ///< samples after which a distance becomes a sliding average: poses drift
    uint32_t max_color_weight = 64;
    /// Frames from colour to colour of a block whose voxels near the surface all have half of max_weight; a voxel there
    /// that has no colour yet waits, too. Colours remember that many times more frames than distances do.
    uint32_t settled_color_every = 4;
    bool color = true;                  ///< without it the model holds distances alone
    uint32_t allocation_stride_px = 2;  ///< every so many pixels allocate, another phase in every frame
    uint32_t seed = 0;                  ///< of the chance by which fused colours are rounded up or down
};

/// The truncation band of a reading right before the camera, metres: no narrower than three voxels.
inline float least_truncation_m(const FusionSettings& settings, float voxel_m) {
    return std::max(settings.truncation_m, 3 * voxel_m);
}

/// The parameters that one frame's fusion passes share. `color_camera` may be the depth camera where there is no
/// colour; `color_frame` counts the frames before this one whose colour was fused. Throws Error when the truncation
/// band is wider than a voxel's distance can express at max_depth_m, or max_weight than its weight can.
gpu::FusionParams make_fusion_params(const VoxelMap& map, const FusionSettings& settings,
                                     const gpu::Camera& depth_camera, const gpu::Camera& color_camera,
                                     uint32_t frame_index, uint32_t color_frame);

/// Makes sure that every block touched by a reading's truncation band is in the map, as far as the pool reaches: touch
/// (insert keys by compare-and-swap), select (which new keys get a block when the pool runs short, by hash of the key),
/// assign (pop ids, clear voxels). `depth_m` is W x H r32f, metres along the optical axis, 0 where there is no reading;
/// `params` holds gpu::FusionParams. A full pool or table leaves existing blocks alone and counts what was refused
/// (gpu::MapCounters). Voxel hashing after Niessner et al. 2013, with the two-phase allocation of Kaehler et al. 2015.
void add_allocate_blocks(graph::FrameGraph& frame, const VoxelMap& map, VoxelMapIds& ids, graph::ImageId depth_m,
                         graph::BufferId params, uint32_t stride_px);

}  // namespace patina
