#pragma once

#include <optional>

#include "engine/graph/frame_graph.h"
#include "patina/reconstruction.h"
#include "reconstruction/frame_context.h"
#include "reconstruction/stages/stages.h"

namespace patina {

class ShownPictures;

/// A view on its way from the device.
class ViewReadback {
  public:
    bool ready() const { return color_.ready(); }
    /// Throws Error before it is ready.
    ModelView get() const;

  private:
    friend ViewReadback wire_view(graph::FrameGraph& graph, Stages& stages, const PosedCamera& camera,
                                  ShownPictures* pictures);
    struct Reflectance {
        graph::Readback kd, ks_alpha, label, rgb, light, model_kd, model_rgb;
        std::optional<graph::Readback> segments;  ///< gpu::SegmentAlbedo per label, where materials are given
        std::optional<graph::Readback> fits;      ///< gpu::WardFit per label, where they are estimated
    };
    graph::Readback position_m_, normal_, color_;
    std::optional<graph::Readback> label_;
    std::optional<Reflectance> reflectance_;
};

/// Declares a view of the model: what a camera sees of its surface, colours, labels and reflectance; with `pictures` as
/// add_model_view() has them.
ViewReadback wire_view(graph::FrameGraph& graph, Stages& stages, const PosedCamera& camera,
                       ShownPictures* pictures = nullptr);

}  // namespace patina
