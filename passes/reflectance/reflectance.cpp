#include "passes/reflectance/reflectance.h"

#include <algorithm>

#include "engine/core/error.h"
#include "passes/reflectance/find_visibility.h"
#include "passes/reflectance/gather_irradiance.h"
#include "passes/reflectance/mark_blocks.h"
#include "passes/reflectance/recolor_surfaces.h"
#include "passes/reflectance/refine_albedo.h"
#include "passes/reflectance/smooth_irradiance.h"
#include "passes/reflectance/surface_albedo.h"

namespace patina {

namespace {

constexpr uint32_t kLeastUpdates = 8;  // in which the window goes through all, however few records there are
constexpr uint32_t kEverything = UINT32_MAX;
constexpr uint32_t kRaysAtTheEnd = 8;  // times as many, where records have but one turn

void check_budget(const char* name, uint32_t records) {
    if (records == 0) throw Error("reflectance.", name, " is 0, it must be at least 1");
}

gpu::ReflectanceParams make_params(const ReflectanceModels& models, const ReflectanceSettings& settings,
                                   uint32_t max_steps, float least_share) {
    gpu::ReflectanceParams params{};
    params.records = models.observation_map.grid();
    params.voxels = models.voxel_map.grid();
    params.edge_shift = models.observation_map.edge_shift();
    params.stamp = models.state.next_stamp();
    params.refreshed = settings.refreshed_records;
    params.max_steps = max_steps;
    params.all = max_steps == gpu::kWindowSteps ? 1 : 0;
    params.shadows = settings.shadows ? 1 : 0;
    params.materials = models.materials.capacity();
    params.least_share = least_share;
    params.ball_m = models.part.ball_m;
    params.cube_m = models.part.cube_m;
    return params;
}

ReflectanceSettings of_everything(ReflectanceSettings settings) {
    settings.first_marched_records = settings.marched_records = settings.refreshed_records = kEverything;
    return settings;
}

ReflectanceFrame make_frame(graph::FrameGraph& frame, const ReflectanceModels& models, const VoxelMapIds& voxels,
                            ObservationMapIds& records, ReflectanceStateIds& state, const ReflectanceAccess& access,
                            const gpu::ReflectanceParams& params, const ReflectanceSettings& settings) {
    return {models.voxel_map,
            voxels,
            access,
            models.observation_map,
            records,
            state,
            models.lights.upload(frame),
            models.materials.import(frame),
            params,
            {settings.first_marched_records, settings.marched_records},
            settings.gathered_rays};
}

RefinedReflectance add_update(graph::FrameGraph& frame, const ReflectanceModels& models, const VoxelMapIds& voxels,
                              ObservationMapIds& records, const RecordList& changed, const ReflectanceAccess& access,
                              const gpu::ReflectanceParams& params, const ReflectanceSettings& settings) {
    ReflectanceStateIds state = models.state.import(frame);
    ReflectanceFrame reflectance = make_frame(frame, models, voxels, records, state, access, params, settings);
    DueRecords due = add_find_due_records(frame, reflectance, changed);
    add_mark_blocks(frame, state, models.voxel_map, voxels);
    if (settings.albedo && settings.gathered_rays > 0) {
        add_gather_irradiance(frame, reflectance, due.march);
        add_smooth_irradiance(frame, reflectance, due.march);
    }
    add_find_visibility(frame, reflectance, due);
    if (settings.albedo) add_refine_albedo(frame, reflectance, due.refine);
    if (settings.albedo && params.all != 0)
        add_surface_albedo(frame, models.observation_map, records, state, reflectance.lights, params.cube_m);
    ReflectanceState::keep(frame, state);
    return {due.march, due.refine};
}

}  // namespace

ReflectanceAccess preferred_reflectance_access(const vulkan::DeviceCaps& caps, const VoxelMap& voxel_map,
                                               const ObservationMap& observation_map) {
    return {preferred_map_access(caps, voxel_map), preferred_map_access(caps, observation_map)};
}

RefinedReflectance add_refine_reflectance(graph::FrameGraph& frame, const ReflectanceModels& models,
                                          const VoxelMapIds& voxels, ObservationMapIds& records,
                                          const RecordList& changed, const ReflectanceAccess& access,
                                          const ReflectanceSettings& settings) {
    check_budget("first_marched_records", settings.first_marched_records);
    check_budget("marched_records", settings.marched_records);
    check_budget("refreshed_records", settings.refreshed_records);
    return add_update(frame, models, voxels, records, changed, access,
                      make_params(models, settings, gpu::kWindowSteps / kLeastUpdates, gpu::kLeastRefreshed), settings);
}

RefinedReflectance add_refine_all_reflectance(graph::FrameGraph& frame, const ReflectanceModels& models,
                                              const VoxelMapIds& voxels, ObservationMapIds& records,
                                              const ReflectanceAccess& access, const ReflectanceSettings& settings) {
    ReflectanceSettings all = of_everything(settings);
    all.gathered_rays *= kRaysAtTheEnd;
    const RecordList none = create_record_list(frame, "reflectance.none", 1);
    return add_update(frame, models, voxels, records, none, access, make_params(models, all, gpu::kWindowSteps, 1),
                      all);
}

void add_relight_reflectance(graph::FrameGraph& frame, const ReflectanceModels& models, VoxelMapIds& voxels,
                             ObservationMapIds& records, graph::BufferId segments, const ReflectanceAccess& access,
                             const ReflectanceSettings& settings, const RelightTurn& turn) {
    ReflectanceSettings all = of_everything(settings);
    all.gathered_rays = turn.gathered_rays;
    ReflectanceStateIds state = models.state.import(frame);
    const VoxelMapIds before = voxels;
    ReflectanceFrame reflectance =
        make_frame(frame, models, before, records, state, access, make_params(models, all, gpu::kWindowSteps, 1), all);
    DueRecords due = add_find_due_records(frame, reflectance, create_record_list(frame, "reflectance.none", 1));
    add_mark_blocks(frame, state, models.voxel_map, voxels);
    if (turn.finds_visibility) add_find_visibility(frame, reflectance, due);
    if (turn.gathered_rays > 0) {
        add_gather_irradiance(frame, reflectance, due.march, true);
        add_smooth_irradiance(frame, reflectance, due.march);
    }
    add_recolor_surfaces(frame, reflectance, voxels, {due.march, segments, turn.gathered_rays > 0});
    ReflectanceState::keep(frame, state);
}

}  // namespace patina
