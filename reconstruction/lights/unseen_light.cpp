#include "reconstruction/lights/unseen_light.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "reconstruction/lights/light_fitting.h"
#include "reconstruction/lights/surface_samples.h"
#include "shared/lighting/lights.h"

namespace patina {
namespace {

constexpr double kMostMisfit = 0.1;  // scenes of lamps and sky have 0.01 to 0.08; a room with patches of sun 0.27
constexpr float kLeastUnseen = 1e-4f;

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

/// What light leaves that is known, as what `ambient` gives the samples (null: the same everywhere).
std::optional<float> left_over(const LitSurface& surface, const ReceivedLight& known, const ReceivedLight& ambient) {
    const FittedIntensities fitted =
        surface.fit(std::span(&known, 1), kIntensitySteps, surface.size(), LightChannel::kMean, ambient);
    const double explained = fitted.intensities[0], rest = fitted.intensities[1];
    if (!(explained > 0) || fitted.misfit > kMostMisfit) return std::nullopt;
    return static_cast<float>(rest / explained);
}

ReceivedLight sum_of(const ReceivedLight& a, const ReceivedLight& b) {
    auto sum = std::make_shared<ReceivedLightValues>(*a);
    for (size_t i = 0; i < sum->by_sample.size(); ++i) sum->by_sample[i] += b->by_sample[i];
    sum->mean += b->mean;
    return sum;
}

}  // namespace

std::optional<float> fit_unseen_light(const LitSurface& surface, const KnownLight& known) {
    const std::optional<float> everywhere = left_over(surface, known.lamps, nullptr);
    const std::optional<float> unknown = left_over(surface, sum_of(known.lamps, known.around), known.unknown);
    if (!everywhere || !unknown) return everywhere ? everywhere : unknown;
    return std::min(*everywhere, *unknown);
}

std::optional<float> find_unseen_light(Pipeline& pipeline, std::span<const Light> lamps) {
    std::vector<gpu::LightSample> drawn = draw_samples(pipeline);
    std::vector<float> around(gpu::kLightSamples), unknown(gpu::kLightSamples);
    for (size_t i = 0; i < gpu::kLightSamples; ++i) {
        const glm::vec4 known(drawn[i].around);
        if (known.w < 0) drawn[i].point_m.w = 0;  // nobody looked what is around it
        around[i] = (known.r + known.g + known.b) / 3;
        unknown[i] = known.w;
    }
    const LitSurface surface(drawn, LightFittingSettings().cell_m);
    if (surface.size() == 0) return std::nullopt;
    const auto found = fit_unseen_light(surface, {surface.received(received_of(pipeline, drawn, lamps)),
                                                  surface.received(around), surface.received(unknown)});
    return found ? std::optional(std::max(*found, kLeastUnseen)) : std::nullopt;
}

}  // namespace patina
