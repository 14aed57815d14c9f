#pragma once

#include "patina/frame.h"

namespace patina {

/// The linear colour of an sRGB-encoded pixel (IEC 61966-2-1), 0..1.
glm::vec3 linear_color(SrgbPixel encoded);

}  // namespace patina
