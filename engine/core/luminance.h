#pragma once

#include <glm/glm.hpp>

namespace patina {

/// Luminance of a linear colour with sRGB's primaries (IEC 61966-2-1), in the colour's unit.
inline double luminance(glm::dvec3 linear) { return glm::dot(linear, glm::dvec3(0.2126, 0.7152, 0.0722)); }
inline float luminance(glm::vec3 linear) { return glm::dot(linear, glm::vec3(0.2126f, 0.7152f, 0.0722f)); }

}  // namespace patina
