#include "reconstruction/model_view.h"

#include "passes/fusion/shade_color.h"
#include "passes/shading/restore_detail.h"
#include "reconstruction/texture/shown_pictures.h"

namespace patina {

namespace {

ModelImages::Reflectance add_reflectance(graph::FrameGraph& graph, Stages& stages, const VoxelMapIds& voxels,
                                         const VisibleBlocks& visible, const RaycastImages& model,
                                         const RestoreDetailInputs& inputs, const PosedCamera& camera,
                                         std::optional<glm::vec4> mirrored_ball_m, const OtherLights* other,
                                         ShownPictures* pictures) {
    ReflectanceStage& stage = *stages.reflectance;
    stage.share_albedo(graph);
    const auto [predicted, segments] = mirrored_ball_m
                                           ? stage.add_predict_mirrors(graph, voxels, visible, model, *mirrored_ball_m)
                                           : stage.add_predict(graph, voxels, visible, model, other);
    // Under other lights than those of the frames, their colours would bring back the shadows of these.
    const ReflectanceStageSettings& settings = stage.settings();
    const bool fused = stages.settings.fusion.color && settings.refine.albedo && settings.detail && !other;
    PredictedImages seen = fused ? add_restore_detail(graph, predicted, inputs) : predicted;
    if (settings.detail && pictures) {
        // What pictures show holds what it mirrored; under the same light no other rays need to tell.
        const bool again = mirrored_ball_m && !pictures->relit();
        const PredictedImages mean = again ? stage.add_predict(graph, voxels, visible, model, other).images : predicted;
        seen = pictures->add_to_view(graph, camera, inputs.position_m, inputs.normal, mean, seen);
    }
    return {seen, predicted, stage.add_coverage(graph, visible, predicted, model.position_m), segments};
}

}  // namespace

ModelImages add_model_view(graph::FrameGraph& graph, Stages& stages, const PosedCamera& camera, Gloss gloss,
                           const OtherLights* other, ShownPictures* pictures) {
    const GeometryStage& geometry = stages.geometry;
    const VoxelMapIds voxels = geometry.map().import(graph);
    const VisibleBlocks visible = geometry.add_visible_to_view(graph, voxels, camera);
    const RaycastImages model =
        geometry.add_sharpened(graph, geometry.add_raycast(graph, voxels, visible), camera.intrinsics);
    ModelImages view;
    view.position_m = model.position_m;
    view.normal = model.normal;
    view.color = add_shade_color(graph, geometry.map(), voxels, visible, model.position_m);
    if (stages.segmentation) view.label = stages.segmentation->add_view(graph, surface_of(visible, model));
    if (stages.reflectance) {
        const RestoreDetailInputs inputs{model.position_m, model.normal, view.color,
                                         static_cast<float>(camera.intrinsics.fx),
                                         stages.reflectance->settings().voxel_m};
        std::optional<glm::vec4> mirrored_ball_m;
        if (gloss == Gloss::kMirrors && !other)
            mirrored_ball_m.emplace(glm::vec3(camera.world_from_camera[3]), stages.settings.around_m);
        view.reflectance =
            add_reflectance(graph, stages, voxels, visible, model, inputs, camera, mirrored_ball_m, other, pictures);
    }
    return view;
}

}  // namespace patina
