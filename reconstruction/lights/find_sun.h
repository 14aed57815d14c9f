#pragma once

#include <optional>
#include <span>

#include "reconstruction/lights/light_estimation.h"
#include "reconstruction/pipeline.h"
#include "shared/lighting/fit_lights.h"

namespace patina {

/// The sun that lights a room through its windows, found in the patches that it makes: brighter by far than lamps and
/// surroundings explain. `drawn` are samples of the surface, as draw_samples returns them; `lights` are the lamps;
/// `ambient` arrives from where nothing is known. The sun is a lamp far away (is_sun); its sightings are the samples in
/// patches. Empty where no direction explains them (search_sun.h). Waits for the device.
std::optional<FoundLight> find_sun(Pipeline& pipeline, std::span<const gpu::LightSample> drawn,
                                   std::span<const Light> lights, glm::vec3 ambient);

/// How strong it is beside another ambient light; its direction stays. Waits for the device.
void measure_sun(Pipeline& pipeline, std::span<const gpu::LightSample> drawn, FoundLight& sun,
                 std::span<const Light> lights, glm::vec3 ambient);

}  // namespace patina
