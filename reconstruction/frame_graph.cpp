#include "reconstruction/frame_graph.h"

#include "passes/fusion/measure_slope.h"
#include "passes/fusion/shade_color.h"
#include "passes/tracking/hide_highlights.h"

namespace patina {

namespace {

/// What the surface reflects: segments, then the observations, what they change of the albedo, and specular materials.
void wire_materials(graph::FrameGraph& graph, Stages& stages, const VoxelMapIds& voxels, const FrameContext& frame,
                    SegmentationInputs segmented, ObservationInputs observed) {
    if (stages.segmentation) {
        if (stages.reflectance)
            stages.segmentation->add_split(graph, voxels, stages.reflectance->observations(), frame);
        if (stages.specular) segmented.fits = stages.specular->fits(graph);
        observed.labels = stages.segmentation->add(graph, voxels, segmented, frame);
    }
    if (!stages.reflectance) return;
    if (!stages.segmentation || stages.segmentation->may_lose_records(frame.index))
        stages.reflectance->reclaim(graph, voxels, stages.geometry.near_surface_m(), frame);
    const ObservationMap& map = stages.reflectance->observations();
    if (stages.segmentation) stages.segmentation->add_relabel(graph, map, stages.reflectance->away(graph), frame.index);
    if (frame.held_out) {
        if (stages.segmentation) stages.segmentation->add_choose_records(graph, map, frame);
        return stages.reflectance->keep(graph);
    }
    const RecordList changed = stages.reflectance->add(graph, voxels, observed, frame);
    if (stages.segmentation) stages.segmentation->add_choose_records(graph, map, frame);
    if (stages.specular) stages.specular->add(graph, *stages.reflectance, *stages.segmentation, changed, frame.index);
}

FrameReadbacks read_counters(graph::FrameGraph& graph, const Stages& stages, const VoxelMapIds& voxels,
                             const VisibleBlocks& visible) {
    FrameReadbacks read{{graph.read_back(voxels.counters)}, graph.read_back(visible.list, 0, sizeof(uint32_t))};
    if (stages.segmentation) read.pools.labels = graph.read_back(stages.segmentation->table().import(graph).counters);
    if (stages.reflectance) {
        const ObservationMapIds observed = stages.reflectance->observations().import(graph);
        read.pools.observed_blocks = graph.read_back(observed.block_counters);
        read.pools.observed_records = graph.read_back(observed.record_counters);
    }
    return read;
}

}  // namespace

FrameReadbacks wire_frame(graph::FrameGraph& graph, Stages& stages, const FrameContext& frame,
                          const InputPictures& pictures) {
    const GeometryStage& geometry = stages.geometry;
    VoxelMapIds voxels = geometry.map().import(graph);

    // Preprocess. Keyframes have the colours that the camera gave: those of a lost frame cannot be corrected.
    InputImages input = add_input(graph, pictures, frame.depth.gpu, stages.settings.input);
    if (stages.keyframes) stages.keyframes->add_keep(graph, {input.depth_m, input.color}, frame);
    const graph::ImageId slope = add_measure_slope(graph, input.filtered_depth_m, frame.depth.intrinsics);
    const graph::BufferId params = geometry.add_params(graph, frame);
    if (stages.color_correction && !frame.precedes)
        input.color = stages.color_correction->add(graph, voxels, input.color, frame);

    // Allocate, integrate.
    geometry.add_allocate(graph, voxels, input.depth_m, params, frame);
    if (stages.segmentation) stages.segmentation->clear_new_blocks(graph, voxels);
    const VisibleBlocks visible = geometry.add_visible(graph, voxels, frame.depth);
    const auto fused_color = frame.fuses_color ? std::optional(input.color) : std::nullopt;
    geometry.add_integrate(graph, voxels, visible, params, {input.depth_m, slope, fused_color});

    // Raycast, segment, observe, refine.
    if (stages.need_raycast()) {
        const RaycastImages cast = geometry.add_raycast(graph, voxels, visible);
        if (stages.tracking) wire_reference(graph, stages, voxels, visible, cast, frame.depth);
        const RaycastImages sharp = geometry.add_sharpened(graph, cast, frame.depth.intrinsics);
        wire_materials(graph, stages, voxels, frame,
                       {surface_of(visible, cast), input.filtered_depth_m, input.color, {}},
                       {sharp.position_m, sharp.normal, input.depth_m, slope, input.color, {}, frame.motion});
        if (stages.settings.view_every_frame) {
            graph.keep(cast.position_m);
            graph.keep(cast.normal);
        }
    }

    geometry.add_remove_empty(graph, voxels, visible, params, frame.index);
    VoxelMap::keep(graph, voxels);
    return read_counters(graph, stages, voxels, visible);
}

void wire_reference(graph::FrameGraph& graph, Stages& stages, const VoxelMapIds& voxels, const VisibleBlocks& visible,
                    const RaycastImages& cast, const PosedCamera& camera) {
    TrackingStage& tracking = *stages.tracking;
    std::optional<graph::ImageId> color;
    if (stages.track_shades()) color = add_shade_color(graph, stages.geometry.map(), voxels, visible, cast.position_m);
    if (color && stages.reflectance && tracking.settings().hide_highlights) {
        const PredictedImages seen = stages.reflectance->add_predict_picture(graph, voxels, visible, cast);
        color = add_hide_highlights(graph, {*color, seen.kd, seen.light, seen.rgb});
    }
    tracking.add_reference(graph, cast, color, camera);
}

}  // namespace patina
