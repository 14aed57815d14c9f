#pragma once

#include <span>
#include <vector>

#include "reconstruction/lights/light_estimation.h"
#include "reconstruction/lights/search_lights.h"
#include "reconstruction/pipeline.h"

namespace patina {

struct LightFittingSettings {
    LightSearchSettings search;
    float white_albedo = 0.8f;  ///< of the brightest surface, which fixes the intensities
    /// With a larger misfit no lamp is believed, as where the sun lights patches. Rooms whose lamps were found have
    /// 0.03 to 0.08, others 0.103, 0.17 and 0.26.
    float most_misfit = 0.1f;
    float cell_m = 1;  ///< surface of one chromaticity within a cube of this size has one albedo
};

/// Lamps found in what they light.
struct FittedLights {
    std::vector<FoundLight> lamps;  ///< brightest first, none where the misfit is too large; sightings are highlights,
                                    ///< spread is that of their mirrored rays
    glm::vec3 ambient{0};           ///< irradiance over pi, linear pixel value
    float misfit = 0;               ///< of the diffuse light, 0 to 1
    float unexplained = 0;          ///< share of the highlights that no lamp explains
};

/// Finds lamps in what a reconstruction with reflectance observed (no lighting sequence is needed): those, and the
/// ambient light, that explain how bright the surface is where its albedo is the same, shadows included, and whose
/// mirrored rays meet in the highlights. One lamp after the other, from all places around what was seen and from
/// `seen`; all are moved whenever there is a new one. Intensities and albedo are known up to one factor, and up to the
/// mean colour of the light, which is taken for white: the brightest albedo becomes `white_albedo`. Waits for the
/// device. Throws Error when the reconstruction has no reflectance.
FittedLights fit_lights(Pipeline& pipeline, std::span<const glm::vec3> seen_m, const LightFittingSettings& settings);

}  // namespace patina
