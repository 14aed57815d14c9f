#include "reconstruction/view_readback.h"

#include <glm/gtc/packing.hpp>

#include "passes/fusion/shade_color.h"
#include "passes/shading/restore_detail.h"
#include "passes/specular/fit_ward.h"

namespace patina {

namespace {

/// Four half floats per pixel to four floats.
Image<glm::vec4> widened(const graph::Readback& read) {
    const Image<uint64_t> halves = read.image<uint64_t>();
    Image<glm::vec4> wide(halves.extent());
    for (size_t i = 0; i < halves.pixels().size(); ++i) wide.pixels()[i] = glm::unpackHalf4x16(halves.pixels()[i]);
    return wide;
}

template <class Segment>
std::vector<std::optional<glm::vec3>> kds_of(const graph::Readback& read) {
    std::vector<std::optional<glm::vec3>> kds;
    for (const Segment& segment : read.as<Segment>()) kds.push_back(kd_of(segment));
    return kds;
}

}  // namespace

ModelView ViewReadback::get() const {
    ModelView view{position_m_.image<glm::vec4>(), widened(normal_), widened(color_)};
    if (label_) view.label = label_->image<uint32_t>();
    if (reflectance_) {
        view.reflectance = {widened(reflectance_->kd),
                            widened(reflectance_->ks_alpha),
                            reflectance_->label.image<uint32_t>(),
                            widened(reflectance_->rgb),
                            widened(reflectance_->light),
                            widened(reflectance_->model_kd),
                            widened(reflectance_->model_rgb),
                            reflectance_->fits ? kds_of<gpu::WardFit>(*reflectance_->fits)
                                               : kds_of<gpu::SegmentAlbedo>(*reflectance_->segments)};
    }
    return view;
}

ViewReadback wire_view(graph::FrameGraph& graph, Stages& stages, const PosedCamera& camera) {
    const GeometryStage& geometry = stages.geometry;
    const VoxelMapIds voxels = geometry.map().import(graph);
    const VisibleBlocks visible = geometry.add_visible_to_view(graph, voxels, camera);
    const RaycastImages model =
        geometry.add_sharpened(graph, geometry.add_raycast(graph, voxels, visible), camera.intrinsics);
    const graph::ImageId color = add_shade_color(graph, geometry.map(), voxels, visible, model.position_m);
    ViewReadback view;
    view.position_m_ = graph.read_back(model.position_m);
    view.normal_ = graph.read_back(model.normal);
    view.color_ = graph.read_back(color);
    if (stages.segmentation)
        view.label_ = graph.read_back(stages.segmentation->add_view(graph, surface_of(visible, model)));
    if (stages.reflectance) {
        const auto [predicted, segments] = stages.reflectance->add_predict(graph, voxels, visible, model);
        const ReflectanceStageSettings& settings = stages.reflectance->settings();
        const RestoreDetailInputs inputs{model.position_m, model.normal, color,
                                         static_cast<float>(camera.intrinsics.fx), settings.voxel_m};
        // Under other lights than those of the frames, their colours would bring back the shadows of these.
        const bool detailed = stages.settings.fusion.color && settings.refine.albedo && settings.detail;
        const PredictedImages seen = detailed ? add_restore_detail(graph, predicted, inputs) : predicted;
        ViewReadback::Reflectance& read = view.reflectance_.emplace();
        read.kd = graph.read_back(seen.kd);
        read.ks_alpha = graph.read_back(seen.ks_alpha);
        read.label = graph.read_back(seen.label);
        read.rgb = graph.read_back(seen.rgb);
        read.light = graph.read_back(seen.light);
        read.model_kd = graph.read_back(predicted.kd);
        read.model_rgb = graph.read_back(predicted.rgb);
        if (stages.specular) {
            read.fits = graph.read_back(stages.specular->fits(graph));
        } else {
            read.segments = graph.read_back(segments);
        }
    }
    return view;
}

}  // namespace patina
