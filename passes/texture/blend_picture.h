#pragma once

#include <optional>

#include "passes/state/texture_band.h"

namespace patina {

/// A picture, and the model as its camera sees it.
struct BlendPictureInputs {
    graph::ImageId color;    ///< rgba16f, linear (add_convert_color)
    graph::ImageId depth_m;  ///< r32f: the model cast into the same view, of any extent (add_cast_depth)
    /// What the model reflects there, of the cast image's extent (PredictedImages).
    struct Reflected {
        graph::ImageId kd, rgb, light;
    };
    std::optional<Reflected> reflected;  ///< empty: colours stand for the albedo
    gpu::Camera camera;                  ///< of the picture
    glm::vec3 gain{1};                   ///< of the picture's colours over the first one's
    float voxel_m = 0;                   ///< of the surface
};

/// Adds to the sums of a band's texels what a picture says of them: (colour / gain - highlight) / light (paper, Eq. 7),
/// per channel. A texel counts where all four pixels of the cast image around show its surface, at least 0.1 of it
/// faces the camera, no pixel of the picture around is clipped, and enough light arrives. Its weight is the square of
/// cosine over squared distance, less towards the picture's border and under a highlight.
TextureBandIds add_blend_picture(graph::FrameGraph& frame, const TextureBand& band, const TextureBandIds& ids,
                                 const BlendPictureInputs& inputs);

}  // namespace patina
