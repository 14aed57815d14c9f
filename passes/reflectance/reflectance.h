#pragma once

#include "passes/reflectance/reflectance_frame.h"
#include "passes/state/lights.h"
#include "passes/state/segment_materials.h"

namespace patina {

/// How much of the reflectance is brought up to date in a frame.
struct ReflectanceSettings {
    bool shadows = true;  ///< false: every light reaches every surface, as in the paper
    bool albedo = true;   ///< false: only visibility is found, under lights that never shone
    /// New records whose lights are marched in a frame at most, about: until then nothing is known of their albedo.
    uint32_t first_marched_records = 8192;
    uint32_t marched_records = 1024;  ///< others whose surface moved, about
    /// And others, looked at again in turn, about; where few records change (gpu::kBusyChanges), few of them are
    /// marched.
    uint32_t refreshed_records = 512;
    /// Rays of each marched record, by which it gathers light from what is around it, not from lamps alone; 0: none, as
    /// in the paper, so that the ambient term is all that there is beside the lamps.
    uint32_t gathered_rays = 0;
};

/// The fastest on this device.
ReflectanceAccess preferred_reflectance_access(const vulkan::DeviceCaps& caps, const VoxelMap& voxel_map,
                                               const ObservationMap& observation_map);

/// Where a refinement works. Everywhere, unless said otherwise.
struct RefinedPart {
    static constexpr float kEverywhere_m = 1e6f;
    glm::vec4 ball_m{0, 0, 0, kEverywhere_m};  ///< centre in the world, radius: what lies outside throws no shadow
    glm::vec4 cube_m{0, 0, 0, kEverywhere_m};  ///< centre, half edge: records that have their turn lie within
};

/// The models that a refinement reads and writes.
struct ReflectanceModels {
    const VoxelMap& voxel_map;
    const ObservationMap& observation_map;
    const Lights& lights;
    SegmentMaterials& materials;
    ReflectanceState& state;
    RefinedPart part{};
};

/// What one frame computed again.
struct RefinedReflectance {
    RecordList marched;  ///< records whose visibility was found
    RecordList refined;  ///< records whose albedo was computed, but for those whose lights were never marched
};

/// Brings visibility and albedo of what is due in this frame up to date: of the records in `changed` (what
/// add_collect_observations returned), and of some others in turn. Versions of the visibility and albedo in
/// `records` are replaced. Throws Error when a budget is 0.
RefinedReflectance add_refine_reflectance(graph::FrameGraph& frame, const ReflectanceModels& models,
                                          const VoxelMapIds& voxels, ObservationMapIds& records,
                                          const RecordList& changed, const ReflectanceAccess& access,
                                          const ReflectanceSettings& settings);

/// The same for all records at once, as at the end of a reconstruction. They gather 8 times as many rays each, and tell
/// each other of their albedo (surface_albedo.h).
RefinedReflectance add_refine_all_reflectance(graph::FrameGraph& frame, const ReflectanceModels& models,
                                              const VoxelMapIds& voxels, ObservationMapIds& records,
                                              const ReflectanceAccess& access, const ReflectanceSettings& settings);

/// One turn of putting records under other lights, those of the models.
struct RelightTurn {
    bool finds_visibility = false;  ///< of the lamps; the first turn does
    /// Rays of each record, by which it gathers light from what is around it, as it was coloured in the turn before; 0:
    /// the ambient term arrives.
    uint32_t gathered_rays = 0;
};

/// Gives the voxels of all records of the models' part the colours that they have under lights that no frame showed
/// (recolor_surfaces.h): a turn without rays for what lamps light at once, and one with rays for each bounce. Albedo
/// stays. `segments`: gpu::SegmentAlbedo per label. `voxels.color`, and the visibility in `records`, are replaced.
void add_relight_reflectance(graph::FrameGraph& frame, const ReflectanceModels& models, VoxelMapIds& voxels,
                             ObservationMapIds& records, graph::BufferId segments, const ReflectanceAccess& access,
                             const ReflectanceSettings& settings, const RelightTurn& turn);

}  // namespace patina
