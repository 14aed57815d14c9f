#pragma once

#include <span>

#include "export/surface_survey.h"
#include "patina/image.h"
#include "patina/lighting.h"

namespace patina {

/// Of a white surface at the mean irradiance of a scene: a well-lit room.
inline constexpr double kMeanIlluminance_lux = 500;

/// The factor from a lamp's intensity (linear pixel value times square metre) to candela with which the surface gets
/// kMeanIlluminance_lux on average over its area: of all lamps together, by luminance, without shadows and reflections
/// between surfaces. Rounded to six digits. 1 where no lamp reaches the surface.
double candela_per_intensity(std::span<const Light> lights, std::span<const Patch> patches);

/// The factor from linear pixel values to candela per square metre with which an environment (light_map.h), not black,
/// gives kMeanIlluminance_lux to a white surface, on average over all that it may face. Rounded to six digits.
double luminance_per_pixel_value(const Image<glm::vec3>& environment);

}  // namespace patina
