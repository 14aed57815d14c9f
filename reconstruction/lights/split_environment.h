#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "patina/image.h"
#include "patina/lighting.h"

namespace patina {

/// Light from afar as a model is lit by it: what is bright and small as lamps, which throw shadows and make highlights,
/// and the rest by direction.
struct SplitEnvironment {
    std::vector<Light> lamps;          ///< kEnvironmentDistance_m away, at most as many as asked for
    std::vector<glm::vec3> far_field;  ///< radiance by texel of gpu::FarFieldTexel
};

inline constexpr double kEnvironmentDistance_m = 1e4;  // so far that a room's size does not matter
inline constexpr size_t kMostEnvironmentLamps = 24;

/// Splits a latitude-longitude picture of radiance, linear pixel values: rows from straight up to straight down, the
/// middle along +x, the right half along +z, y up, as Blender and three.js read an environment. `picture_from_world` is
/// a rotation.
///
/// What is brighter than 4 times the mean over all directions is the lamps', as far as it is brighter. It is divided
/// until no lamp stands for much light far from its middle. What stays wider than 10 degrees goes back to the rest.
/// Where `most_lamps` is 0, all is the rest. Throws Error for a picture without pixels.
SplitEnvironment split_environment(const Image<glm::vec3>& picture, const glm::dmat3& picture_from_world,
                                   size_t most_lamps = kMostEnvironmentLamps);

}  // namespace patina
