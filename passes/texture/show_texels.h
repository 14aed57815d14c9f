#pragma once

#include "passes/state/texture_band.h"

namespace patina {

/// Places the surface that a view shows in a page of its extent, with sums that are 0. A pixel where nothing was hit,
/// or kd or the normal is not known, shows none. `position_m`, `normal`: as PredictRadianceInputs has them; `kd`: as
/// PredictedImages. Throws Error when extents differ.
ViewTexelIds add_place_view(graph::FrameGraph& frame, const TextureBand& page, graph::ImageId position_m,
                            graph::ImageId normal, graph::ImageId kd);

/// What a view looks like without pictures; each as PredictedImages has it.
struct ShowTexelsInputs {
    graph::ImageId kd, rgb, picture_kd, light;   ///< by records
    graph::ImageId kd_elsewhere, rgb_elsewhere;  ///< what is shown where no picture shows the surface
    double pixel_m = 0;                          ///< about how far pixels are apart on the surface
    bool other_light = false;                    ///< `rgb` is under other light than the pictures
};

struct ShownTexels {
    graph::ImageId kd;   ///< W x H rgba16f: a: 1 where it is known, else all is 0
    graph::ImageId rgb;  ///< W x H rgba16f: linear pixel value, a: as kd
};

/// The view with what pictures tell (add_blend_diffuse). kd is their albedo, balanced over kBalanceReach_m with
/// what records know. rgb is what they show, with the highlights of the inputs' rgb in place of theirs;
/// under other light it is the balanced kd in that. Up to three pixels beside what they show it
/// counts, too, on the same surface.
ShownTexels add_show_texels(graph::FrameGraph& frame, const TextureBand& page, const ViewTexelIds& view,
                            const ShowTexelsInputs& inputs);

}  // namespace patina
