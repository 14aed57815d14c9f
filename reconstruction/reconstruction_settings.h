#pragma once

#include <cstdint>
#include <optional>

#include "passes/fusion/allocate_blocks.h"
#include "passes/input/input.h"
#include "passes/photometry/estimate_gains.h"
#include "passes/state/voxel_map.h"
#include "reconstruction/stages/keyframe_stage.h"
#include "reconstruction/stages/reflectance_stage.h"
#include "reconstruction/stages/segmentation_stage.h"
#include "reconstruction/stages/specular_stage.h"
#include "reconstruction/stages/tracking_stage.h"

namespace patina {

/// All settings of a reconstruction; plain values, echoed whole in run.json.
struct ReconstructionSettings {
    VoxelMapSettings map;
    FusionSettings fusion;
    InputSettings input;
    float near_m = 0.1f;         ///< nothing nearer to a camera is cast
    uint32_t remove_every = 16;  ///< blocks without surface are removed every so many frames; 0 keeps them
    /// What lies farther from the camera, metres, throws no shadow until it comes near again; and where it is not in
    /// view, its blocks may leave the device.
    float around_m = 8;
    uint32_t resident_blocks = 65536;  ///< while more are in use, blocks that are far away leave the device; 0: none do
    uint32_t host_mib = 256;  ///< of memory for blocks that left; beyond, they go to a temporary file; 0: no limit
    /// Estimates each frame's colour gains, for cameras that change exposure or white balance by themselves; empty:
    /// colours are taken as they are. Needs fusion.color.
    std::optional<GainSettings> gains{};
    /// Observations and albedo beside the geometry; empty: none. Needs lights (Pipeline::set_lights).
    std::optional<ReflectanceStageSettings> reflectance{};
    /// Segments of the map; empty: none.
    std::optional<SegmentationSettings> segmentation{};
    /// Specular materials of the segments; empty: those that the reflectance was given. Needs both of the former.
    std::optional<SpecularSettings> specular{};
    std::optional<NetworkDescription> network{};  ///< that estimates specular materials; empty: none
    /// Finds the frames' poses; empty: they are given.
    std::optional<TrackingSettings> tracking{};
    /// Keyframes of what is fused, by which a camera that tracking lost is found again; empty: none.
    std::optional<KeyframeSettings> keyframes{};
    /// Of all that is drawn at random: ferns of keyframes, the records that stand for a segment, those that the network
    /// is shown, the samples that lights are fitted to, and how fused colours are rounded. Each of these has a seed of
    /// its own, which this one changes; 0 leaves it.
    uint64_t seed = 0;
    bool view_every_frame = false;  ///< cast the model into every depth frame, as a live view or a tracker needs it
};

}  // namespace patina
