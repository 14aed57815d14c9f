#pragma once

#include "patina/frame.h"

namespace patina {

/// The linear colour of an sRGB-encoded pixel (IEC 61966-2-1), 0..1.
glm::vec3 linear_color(SrgbPixel encoded);

/// The sRGB code, 0..1, of a linear value of 0..1.
double srgb_encoded(double linear);

}  // namespace patina
