#pragma once

#include "passes/texture/blend_picture.h"

namespace patina {

/// What a picture says of the albedo of what it shows: (colour / gain - highlight) / light (paper, Eq. 7), per channel.
/// Nothing where the picture is clipped or invalid, too little light arrives, or most of what is seen is a highlight.
/// `inputs` must have what the model reflects. Writes `albedo`, of the picture's extent: rgba16f, linear, up to 1.5; a
/// is gpu::kColorValid where it is known, else all is 0. Such a picture blends as a colour that stands for the albedo
/// (add_blend_picture without `reflected`), also when the model's light is another one by then. Throws Error when it
/// has another extent.
graph::ImageId add_albedo_picture(graph::FrameGraph& frame, const BlendPictureInputs& inputs, graph::ImageId albedo);

}  // namespace patina
