#pragma once

#include "engine/core/image.h"
#include "passes/input/picture.h"

namespace patina::reference {

/// What add_convert_depth computes, for lenses whose distortion does not fold back within the picture.
Image<float> convert_depth(const DepthInput& input);

}  // namespace patina::reference
