#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "reconstruction/pipeline.h"
#include "shared/lighting/fit_lights.h"

namespace patina {

/// Samples of what a reconstruction observed, as add_sample_surface draws them. Waits for the device, so that all
/// frames are fused. Throws Error when the reconstruction has no reflectance.
std::vector<gpu::LightSample> draw_samples(Pipeline& pipeline);

/// What lamps of intensity 1 at these places give samples of the surface, at most gpu::kLightSamples of them, as
/// add_try_lights returns it: for each lamp a row of samples.size(). As many are tried at once as a pass takes. Waits
/// for the device.
std::vector<float> try_lamps(Pipeline& pipeline, std::span<const gpu::LightSample> samples,
                             std::span<const glm::vec3> places_m);

/// The same of suns, as add_try_suns returns it.
std::vector<float> try_suns(Pipeline& pipeline, std::span<const gpu::LightSample> samples,
                            std::span<const glm::vec3> directions, glm::vec4 ball_m);

/// Centre and radius of what holds all samples, and what stands between them.
glm::vec4 ball_around(std::span<const gpu::LightSample> samples);

/// Irradiance over pi that lights give the first gpu::kLightSamples samples, those of the surface.
std::vector<glm::vec3> received_from(Pipeline& pipeline, std::span<const gpu::LightSample> samples,
                                     std::span<const Light> lights);

}  // namespace patina
