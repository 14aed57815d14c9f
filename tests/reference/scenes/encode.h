#pragma once

#include "patina/image.h"
#include "scenes/description/recording.h"

namespace patina::reference {

/// Depth readings in metres before they are rounded to units; 0 where nothing was seen. The random numbers are those of
/// shaders/lib/math/random.glsl, which are part of a sequence's definition; everything else is computed anew, in double
/// precision.
Image<double> read_depth_m(const Image<float>& depth_m, const scenes::SensorNoise& noise, const scenes::NoiseKey& key);

/// Linear colour as a sensor holds it.
Image<glm::dvec3> expose_color(const Image<glm::vec4>& radiance, double exposure, const scenes::SensorNoise& noise,
                               const scenes::NoiseKey& key);

}  // namespace patina::reference
