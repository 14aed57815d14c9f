#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "shared/lighting/fit_lights.h"

namespace patina {

/// A sun that explains patches of a surface.
struct SunInPatches {
    glm::vec3 direction{0};    ///< to it, unit length
    glm::dvec3 irradiance{0};  ///< over pi, of a surface that faces it, linear pixel value
    float precision = 0;       ///< share of the samples that it lights that are bright
    float recall = 0;          ///< share of the bright samples that it lights
    uint32_t samples = 0;      ///< bright ones that it lights
};

/// What suns in these directions give the samples: the cosine, 0 where they do not shine in. A row of samples for each
/// direction.
using TrySuns =
    std::function<std::vector<float>(std::span<const gpu::LightSample> samples, std::span<const glm::vec3> directions)>;

/// Finds the direction that lights the samples that are bright, and not the others. Bright is what reflects more than
/// three times what samples of its chromaticity mostly reflect of the light that is known, or what a fifth of those
/// within 1.5 m on the same surface do not exceed: a sun may light most of a bed. `known` is the irradiance over pi by
/// sample. Directions all around are tried, and the best is moved by ever smaller angles. Empty where too few samples
/// are bright, or no direction lights most of them and few others.
std::optional<SunInPatches> search_sun(std::span<const gpu::LightSample> samples, std::span<const glm::vec3> known,
                                       const TrySuns& try_suns);

/// SunInPatches::irradiance of a sun that gives the samples these cosines. Empty where no sample in a patch has samples
/// beside it on the same surface that the sun does not reach.
std::optional<glm::dvec3> sun_strength(std::span<const gpu::LightSample> samples, std::span<const glm::vec3> known,
                                       std::span<const float> cosines);

}  // namespace patina
