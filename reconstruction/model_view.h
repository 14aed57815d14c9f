#pragma once

#include <optional>

#include "engine/graph/frame_graph.h"
#include "reconstruction/frame_context.h"
#include "reconstruction/stages/stages.h"

namespace patina {

class ShownPictures;

/// What a camera sees of the model, on the device; all images have its extent.
struct ModelImages {
    graph::ImageId position_m;            ///< rgba32f: world; w: depth along the optical axis, 0: nothing was hit
    graph::ImageId normal;                ///< rgba16f: world, unit length; 0 where nothing was hit
    graph::ImageId color;                 ///< rgba16f: linear; a = 0 where there is none
    std::optional<graph::ImageId> label;  ///< r32ui; empty without segmentation
    struct Reflectance {
        PredictedImages seen;       ///< with detail of pictures, or of the fused colour, where settings say so
        PredictedImages predicted;  ///< without
        graph::ImageId coverage;    ///< add_sample_coverage
        graph::BufferId segments;   ///< gpu::SegmentAlbedo per label
    };
    std::optional<Reflectance> reflectance;  ///< empty where the model has none
};

/// Declares a view of the model: what a camera sees of its surface, colours, labels and reflectance. What nobody uses
/// is culled. `pictures`: what they show has the albedo that they tell; null without. Under other lights glossy
/// surfaces mirror nothing. Throws Error as Lights::set does.
ModelImages add_model_view(graph::FrameGraph& graph, Stages& stages, const PosedCamera& camera, Gloss gloss,
                           const OtherLights* other = nullptr, ShownPictures* pictures = nullptr);

}  // namespace patina
