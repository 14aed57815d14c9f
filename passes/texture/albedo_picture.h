#pragma once

#include "passes/texture/blend_picture.h"

namespace patina {

/// What a picture says of the albedo of what it shows: (colour / gain - highlight) / light (paper, Eq. 7), per channel.
/// `inputs` must have what the model reflects. Writes `albedo`, of the picture's extent: rgba16f, linear. Its a is
/// gpu::kColorValid where that is the albedo, up to 1.5. It is gpu::kColorClipped where it tells what is seen alone:
/// the picture is clipped (a clipped channel is taken to be as bright as the model says, if that is more), too little
/// light arrives, or most is a highlight; then it may be below 0. Else all is 0: the picture is invalid, or shows no
/// surface. Such a picture blends as a colour that stands for the albedo (add_blend_picture without `reflected`), also
/// when the model's light is another one by then. Throws Error when it has another extent.
graph::ImageId add_albedo_picture(graph::FrameGraph& frame, const BlendPictureInputs& inputs, graph::ImageId albedo);

}  // namespace patina
