#include "reconstruction/lights/unseen_light.h"

#include <vector>

#include "reconstruction/lights/light_fitting.h"
#include "reconstruction/lights/surface_samples.h"
#include "shared/lighting/lights.h"

namespace patina {
namespace {

constexpr double kMostMisfit = 0.1;  // scenes of lamps and sky have 0.01 to 0.08; a room with patches of sun 0.27

/// What the lamps together give each sample.
std::vector<float> received_of(Pipeline& pipeline, std::span<const gpu::LightSample> drawn,
                               std::span<const Light> lamps) {
    static_assert(gpu::kMaxPointLights <= gpu::kTrialLights, "all lamps are tried at once");
    std::vector<glm::vec3> places_m;
    for (const Light& lamp : lamps) places_m.emplace_back(lamp.position_m);
    const std::vector<float> tried = try_lamps(pipeline, drawn, places_m);
    std::vector<float> received(gpu::kLightSamples);
    for (size_t l = 0; l < lamps.size(); ++l) {
        const auto intensity = static_cast<float>(glm::dot(lamps[l].intensity, glm::dvec3(1)) / 3);
        for (size_t i = 0; i < gpu::kLightSamples; ++i) received[i] += intensity * tried[l * gpu::kLightSamples + i];
    }
    return received;
}

}  // namespace

std::optional<float> fit_unseen_light(const LitSurface& surface, const ReceivedLight& received) {
    const FittedIntensities fitted = surface.fit(std::span(&received, 1), kIntensitySteps, surface.size());
    const double lamps = fitted.intensities[0], rest = fitted.intensities[1];
    if (!(lamps > 0) || fitted.misfit > kMostMisfit) return std::nullopt;
    return static_cast<float>(rest / lamps);
}

std::optional<float> find_unseen_light(Pipeline& pipeline, std::span<const Light> lamps) {
    const std::vector<gpu::LightSample> drawn = draw_samples(pipeline);
    const LitSurface surface(drawn, LightFittingSettings().cell_m);
    if (surface.size() == 0) return std::nullopt;
    return fit_unseen_light(surface, surface.received(received_of(pipeline, drawn, lamps)));
}

}  // namespace patina
