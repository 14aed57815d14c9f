#pragma once

#include <optional>
#include <span>

#include "reconstruction/lights/light_estimation.h"
#include "reconstruction/pipeline.h"

namespace patina {

/// The sun that lights a room through its windows, found in the patches that it makes of what the pipeline observed:
/// brighter by far than lamps and surroundings explain. `lights` are the lamps, `ambient` arrives from where nothing is
/// known. It is a lamp far away (is_sun); its sightings are the samples of the surface in patches. Empty where no
/// direction explains them (search_sun.h). Waits for the device. Throws Error when the reconstruction has no
/// reflectance.
std::optional<FoundLight> find_sun(Pipeline& pipeline, std::span<const Light> lights, glm::vec3 ambient);

/// How strong it is beside another ambient light; its direction stays.
void measure_sun(Pipeline& pipeline, FoundLight& sun, std::span<const Light> lights, glm::vec3 ambient);

}  // namespace patina
