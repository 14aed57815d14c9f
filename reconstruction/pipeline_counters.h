#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "passes/tracking/judge_motion.h"
#include "reconstruction/growing_pools.h"

namespace patina {

/// How full the pools of the observations are.
struct ObservationCounters {
    gpu::MapCounters blocks{};
    gpu::MapCounters records{};  ///< their block is a voxel's record
};

/// What is counted in a frame, in the words of the shaders that count: those of the last fused frame whose work the
/// device has finished. Public Statistics are made from it (statistics_of); this has more than they show, for the
/// library's own programs and tests, and types that the public API may not name.
struct PipelineCounters {
    uint32_t frames = 0;  ///< fused so far, those included that the device works on
    gpu::MapCounters map{};
    uint32_t visible_blocks = 0;               ///< that the depth camera saw
    ObservationCounters observations;          ///< zero without reflectance
    gpu::SegmentCounters segments{};           ///< zero without segmentation
    LabelStability label_stability;            ///< over all frames that were counted
    std::vector<PoolState> pools;              ///< how full they are, and what keeps them from growing
    std::optional<TrackingReport> tracking{};  ///< of the last frame that was added; empty where poses are given
};

}  // namespace patina
