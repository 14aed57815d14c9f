#pragma once

#include "patina/frame.h"
#include "patina/image.h"

namespace patina::reference {

/// What add_convert_depth computes, for lenses whose distortion does not fold back within the picture.
Image<float> convert_depth(const DepthInput& input);

}  // namespace patina::reference
