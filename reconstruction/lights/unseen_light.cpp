#include "reconstruction/lights/unseen_light.h"

#include <algorithm>
#include <vector>

#include "reconstruction/lights/light_fitting.h"
#include "reconstruction/lights/surface_samples.h"
#include "shared/lighting/lights.h"

namespace patina {
namespace {

constexpr double kMostMisfit = 0.1;  // scenes of lamps and sky have 0.01 to 0.08; a room with patches of sun 0.27
constexpr float kLeastUnseen = 1e-4f;
constexpr float kBrightestAlbedo = 0.9f;  // of white paint; few things have more
constexpr float kLeastReach = 0.02f;      // share of directions, below which unseen light is no explanation

float mean_of(const auto& rgb) { return (rgb.r + rgb.g + rgb.b) / 3; }

/// What light leaves that is known, as what `ambient` gives the samples (null: the same everywhere).
std::optional<float> left_over(const LitSurface& surface, const ReceivedLight& known, const ReceivedLight& ambient) {
    const FittedIntensities fitted =
        surface.fit(std::span(&known, 1), kIntensitySteps, surface.size(), LightChannel::kMean, ambient);
    const double explained = fitted.intensities[0], rest = fitted.intensities[1];
    if (!(explained > 0) || fitted.misfit > kMostMisfit) return std::nullopt;
    return static_cast<float>(rest / explained);
}

}  // namespace

std::optional<float> fit_unseen_light(const LitSurface& surface, const KnownLight& known) {
    const std::optional<float> everywhere = left_over(surface, known.lamps, nullptr);
    const std::optional<float> unknown = left_over(surface, known.all, known.unknown);
    if (!everywhere || !unknown) return everywhere ? everywhere : unknown;
    return std::min(*everywhere, *unknown);
}

std::optional<float> least_strength(std::span<const gpu::LightSample> samples, std::span<const float> received,
                                    std::span<const float> reached, float albedo, double share) {
    std::vector<float> asked;
    for (size_t i = 0; i < samples.size(); ++i)
        if (reached[i] > 0) asked.push_back((mean_of(samples[i].diffuse) / albedo - received[i]) / reached[i]);
    if (asked.empty()) return std::nullopt;
    const auto at = asked.begin() + static_cast<ptrdiff_t>((1 - share) * static_cast<double>(asked.size() - 1));
    std::nth_element(asked.begin(), at, asked.end());
    return *at;
}

float least_unseen_light(std::span<const gpu::LightSample> samples, std::span<const float> received) {
    std::vector<float> reached;
    for (const gpu::LightSample& sample : samples)
        reached.push_back(sample.point_m.w > 0 && sample.around.w >= kLeastReach ? sample.around.w : 0);
    return std::max(least_strength(samples, received, reached, kBrightestAlbedo, kBrighterShare).value_or(0), 0.0f);
}

std::optional<float> find_unseen_light(Pipeline& pipeline, std::vector<gpu::LightSample> drawn,
                                       std::span<const Light> lights) {
    for (gpu::LightSample& sample : drawn)
        if (sample.around.w < 0) sample.point_m.w = 0;  // nobody looked what is around it
    const LitSurface surface(drawn, LightFittingSettings().cell_m);
    if (surface.size() == 0) return std::nullopt;
    const std::vector<glm::vec3> received = received_from(pipeline, drawn, lights);
    std::vector<float> sent, all, unknown;
    for (size_t i = 0; i < gpu::kLightSamples; ++i) {
        sent.push_back(mean_of(received[i]));
        all.push_back(sent.back() + mean_of(drawn[i].around));
        unknown.push_back(drawn[i].around.w);
    }
    const auto found =
        fit_unseen_light(surface, {surface.received(sent), surface.received(all), surface.received(unknown)});
    if (!found) return std::nullopt;
    // What is not modelled of a sun (soft borders, gloss) would be taken for such light.
    const float fitted = std::ranges::any_of(lights, is_sun) ? 0 : *found;
    return std::max({fitted, least_unseen_light(drawn, all), kLeastUnseen});
}

}  // namespace patina
