#include "reconstruction/lights/find_sun.h"

#include <algorithm>
#include <numbers>
#include <vector>

#include "engine/core/shader_light.h"
#include "reconstruction/lights/search_sun.h"
#include "reconstruction/lights/split_environment.h"
#include "reconstruction/lights/surface_samples.h"

namespace patina {
namespace {

TrySuns try_in_volume(Pipeline& pipeline, std::span<const gpu::LightSample> all) {
    return [&pipeline, ball_m = ball_around(all)](std::span<const gpu::LightSample> samples,
                                                  std::span<const glm::vec3> directions) {
        return try_suns(pipeline, samples, directions, ball_m);
    };
}

/// Irradiance over pi from around. Unknown directions send the ambient light, or as much as the others where that is
/// not known (lib/records/gathered_light.glsl).
glm::vec3 gathered(const gpu::LightSample& sample, glm::vec3 ambient) {
    const glm::vec3 met(sample.around);
    const float unknown = std::max(sample.around.w, 0.0f);
    if (ambient != glm::vec3(0)) return met + unknown * ambient;
    return unknown < 1 ? met / (1 - unknown) : glm::vec3(0);
}

/// Irradiance over pi without the sun's.
std::vector<glm::vec3> known_light(Pipeline& pipeline, std::span<const gpu::LightSample> samples,
                                   std::span<const Light> lights, glm::vec3 ambient) {
    std::vector<glm::vec3> known = received_from(pipeline, samples, lights);
    for (size_t i = 0; i < samples.size(); ++i) known[i] += gathered(samples[i], ambient);
    return known;
}

Light sun_of(glm::vec3 direction, glm::dvec3 irradiance) {
    Light sun;
    sun.position_m = kEnvironmentDistance_m * glm::dvec3(direction);
    sun.intensity = kEnvironmentDistance_m * kEnvironmentDistance_m * std::numbers::pi * irradiance;
    return rounded_to_float(sun);
}

}  // namespace

std::optional<FoundLight> find_sun(Pipeline& pipeline, std::span<const gpu::LightSample> drawn,
                                   std::span<const Light> lights, glm::vec3 ambient) {
    const std::span<const gpu::LightSample> samples = drawn.first(gpu::kLightSamples);
    const auto sun =
        search_sun(samples, known_light(pipeline, samples, lights, ambient), try_in_volume(pipeline, samples));
    if (!sun) return std::nullopt;
    return FoundLight{sun_of(sun->direction, sun->irradiance), {.sightings = sun->samples}};
}

void measure_sun(Pipeline& pipeline, std::span<const gpu::LightSample> drawn, FoundLight& sun,
                 std::span<const Light> lights, glm::vec3 ambient) {
    const std::span<const gpu::LightSample> samples = drawn.first(gpu::kLightSamples);
    const glm::vec3 direction(glm::normalize(sun.light.position_m));
    const auto strength = sun_strength(samples, known_light(pipeline, samples, lights, ambient),
                                       try_suns(pipeline, samples, std::span(&direction, 1), ball_around(samples)));
    if (strength) sun.light = sun_of(direction, *strength);
}

}  // namespace patina
