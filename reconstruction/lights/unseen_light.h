#pragma once

#include <optional>
#include <span>

#include "reconstruction/lights/fit_intensities.h"
#include "reconstruction/pipeline.h"

namespace patina {

/// What arrives beside lamps whose intensities are known, such as the light of a sky that no frame shows: irradiance
/// over pi (linear pixel value, mean of the channels), as if it came alike from everywhere. Shadows tell it, and
/// surface that turns away from the lamps: where one albedo receives little of them, the rest of its light is other
/// light. `received` is what all lamps together give the surface's samples, mean of the channels. Empty where that does
/// not explain the surface: where it has many albedos of one chromaticity, or much of its light comes in patches, as a
/// sun's.
std::optional<float> fit_unseen_light(const LitSurface& surface, const ReceivedLight& received);

/// That of what the pipeline has observed, under lamps of these intensities. It is taken for white, as its colour is
/// too uncertain. At least one lamp, at most gpu::kMaxPointLights. Waits for the device. Throws Error when the
/// reconstruction has no reflectance.
std::optional<float> find_unseen_light(Pipeline& pipeline, std::span<const Light> lamps);

}  // namespace patina
