#pragma once

#include "passes/texture/blend_picture.h"

namespace patina {

/// What a picture tells of the surface that it shows: the two terms of (colour / gain - highlight) / light (paper,
/// Eq. 7). Both rgba16f, linear, of the picture's extent.
struct DiffusePicture {
    /// What leaves without the highlight. a: gpu::kColorValid where it tells the albedo, up to 1.5. gpu::kColorClipped
    /// where it is what is seen alone: the picture is clipped (a clipped channel is taken to be as bright as the model
    /// says, if that is more), too little light arrives, or most is a highlight; then it may be below 0. 0.25 within 2
    /// pixels of where the surface ends or bends sharply: what is seen may be another one. Else all is 0: the picture
    /// is invalid, or shows no surface.
    graph::ImageId diffuse;
    graph::ImageId light;  ///< irradiance over pi; 0 where `diffuse` is; a unused
};

/// Takes a picture apart. `inputs` must have what the model reflects. Writes `targets`. Throws Error when they have
/// another extent than the picture.
DiffusePicture add_diffuse_picture(graph::FrameGraph& frame, const BlendPictureInputs& inputs,
                                   const DiffusePicture& targets);

}  // namespace patina
