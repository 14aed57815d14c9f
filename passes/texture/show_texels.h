#pragma once

#include "passes/shading/predict_radiance.h"
#include "passes/state/texture_band.h"

namespace patina {

/// Places the surface that a view shows in a page of its extent, with sums that are 0. A pixel where nothing was hit,
/// or kd or the normal is not known, shows none. `position_m`, `normal`: as PredictRadianceInputs has them. Throws
/// Error when extents differ.
ViewTexelIds add_place_view(graph::FrameGraph& frame, const TextureBand& page, graph::ImageId position_m,
                            graph::ImageId normal, const PredictedImages& predicted);

/// What a view looks like without pictures.
struct ShowTexelsInputs {
    PredictedImages predicted;  ///< by records
    PredictedImages elsewhere;  ///< what is shown where no picture shows the surface
    double pixel_m = 0;         ///< about how far pixels are apart on the surface
    bool other_light = false;   ///< `predicted` is under other light than the pictures
};

/// The view with what pictures tell (add_blend_picture_for). kd is their albedo,
/// balanced over kBalanceReach_m with what records know. rgb is what they show, with the highlights of `predicted` in
/// place of theirs: light that is wrong cancels out; under other light it is the balanced kd in that. Up to three
/// pixels beside what they show it counts, too, on the same surface. Returns `elsewhere` with kd and rgb replaced.
PredictedImages add_show_texels(graph::FrameGraph& frame, const TextureBand& page, const ViewTexelIds& view,
                                const ShowTexelsInputs& inputs);

}  // namespace patina
