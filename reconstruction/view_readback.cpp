#include "reconstruction/view_readback.h"

#include <glm/gtc/packing.hpp>

#include "passes/specular/fit_ward.h"
#include "reconstruction/model_view.h"

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

ViewReadback wire_view(graph::FrameGraph& graph, Stages& stages, const PosedCamera& camera, ShownPictures* pictures) {
    const ModelImages model = add_model_view(graph, stages, camera, Gloss::kMirrors, nullptr, pictures);
    ViewReadback view;
    view.position_m_ = graph.read_back(model.position_m);
    view.normal_ = graph.read_back(model.normal);
    view.color_ = graph.read_back(model.color);
    if (model.label) view.label_ = graph.read_back(*model.label);
    if (model.reflectance) {
        const auto& [seen, predicted, coverage, segments] = *model.reflectance;
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
