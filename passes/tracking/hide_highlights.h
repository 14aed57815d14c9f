#pragma once

#include "engine/graph/frame_graph.h"

namespace patina {

/// What a camera sees of a model whose materials are known (shading/predict_radiance.h); all W x H rgba16f.
struct HighlightInputs {
    graph::ImageId color_linear;  ///< the model's fused colour, a = 0 where there is none
    graph::ImageId kd;            ///< a = 1 where it is known
    graph::ImageId light;         ///< what kd multiplies in rgb
    graph::ImageId rgb;           ///< the re-rendering
};

/// The model's colours without those pixels whose re-rendering is specular by more than `most_share` of its luminance:
/// highlights stay behind when the camera moves, and would pull it along. Where no material is known, colours stay.
/// Returns W x H rgba16f, all 0 where there is no colour. Throws Error when images differ in extent.
graph::ImageId add_hide_highlights(graph::FrameGraph& frame, const HighlightInputs& inputs, float most_share = 0.15f);

}  // namespace patina
