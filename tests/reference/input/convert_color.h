#pragma once

#include "patina/frame.h"
#include "patina/image.h"

namespace patina::reference {

/// What add_convert_color computes, for lenses whose distortion does not fold back within the picture.
Image<glm::vec4> convert_color(const ColorInput& input);

}  // namespace patina::reference
