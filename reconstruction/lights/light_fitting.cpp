#include "reconstruction/lights/light_fitting.h"

#include <algorithm>
#include <array>

#include "engine/core/shader_light.h"
#include "reconstruction/lights/surface_samples.h"
#include "reconstruction/lights/try_in_volume.h"

namespace patina {
namespace {

constexpr float kBrightQuantile = 0.95f;
constexpr float kExplained = 0.5f;  // a highlight, by a lamp

/// What the brightest groups' albedo is when every sample receives 1 on the mean.
double brightest_albedo(const std::array<FittedIntensities, 3>& channels) {
    std::vector<float> albedo;
    for (size_t g = 0; g < channels[0].albedo.size(); ++g) {
        const float most = std::max({channels[0].albedo[g], channels[1].albedo[g], channels[2].albedo[g]});
        if (most > 0) albedo.push_back(most);
    }
    if (albedo.empty()) return 0;
    const auto at = static_cast<ptrdiff_t>(kBrightQuantile * static_cast<float>(albedo.size() - 1));
    std::nth_element(albedo.begin(), albedo.begin() + at, albedo.end());
    return albedo[static_cast<size_t>(at)];
}

/// Sightings are the highlights that no other lamp explains better, spread the median distance of their mirrored rays.
LightEvidence measure_highlights(const LitSurface& surface, std::span<const TrialLamp> lamps, size_t index) {
    std::vector<float> off_m;
    for (size_t i = 0; i < surface.highlights().size(); ++i) {
        const float own = lamps[index].unexplained[i];
        const bool best = std::all_of(lamps.begin(), lamps.end(),
                                      [&](const TrialLamp& other) { return other.unexplained[i] >= own; });
        if (!best || own > kExplained) continue;
        const gpu::LightSample& sample = surface.highlights()[i];
        const glm::vec3 normal(sample.normal), viewer(sample.highlight);
        const glm::vec3 mirrored = 2 * glm::dot(viewer, normal) * normal - viewer;
        off_m.push_back(glm::length(glm::cross(lamps[index].place_m - glm::vec3(sample.point_m), mirrored)));
    }
    LightEvidence evidence{.sightings = static_cast<uint32_t>(off_m.size())};
    if (off_m.empty()) return evidence;
    const auto middle = off_m.begin() + static_cast<ptrdiff_t>(off_m.size() / 2);
    std::nth_element(off_m.begin(), middle, off_m.end());
    evidence.spread_m = *middle;
    return evidence;
}

FittedLights summarise(const LitSurface& surface, std::span<const TrialLamp> lamps,
                       const LightFittingSettings& settings) {
    std::vector<ReceivedLight> received;
    for (const TrialLamp& lamp : lamps) received.push_back(lamp.received);
    std::array<FittedIntensities, 3> channels;
    for (int c = 0; c < 3; ++c)
        channels[c] = surface.fit(received, kIntensitySteps, surface.size(), static_cast<LightChannel>(c));
    const double scale = brightest_albedo(channels) / double{settings.white_albedo};
    FittedLights fitted;
    for (size_t l = 0; l < lamps.size(); ++l) {
        Light lamp{.position_m = glm::dvec3(lamps[l].place_m), .axis = glm::dvec3(lamps[l].axis)};
        for (int c = 0; c < 3; ++c) lamp.intensity[c] = scale * channels[c].intensities[l];
        fitted.lamps.push_back({rounded_to_float(lamp), measure_highlights(surface, lamps, l)});
    }
    for (int c = 0; c < 3; ++c) fitted.ambient[c] = static_cast<float>(scale * channels[c].intensities.back());
    sort_brightest_first(fitted.lamps);
    const FittedIntensities all = surface.fit(received, kIntensitySteps, surface.size());
    fitted.misfit = static_cast<float>(all.misfit);
    fitted.unexplained = static_cast<float>(unexplained_highlights(surface, lamps, all.intensities));
    if (fitted.misfit > settings.most_misfit) fitted.lamps.clear();
    return fitted;
}

}  // namespace

FittedLights fit_lights(Pipeline& pipeline, std::span<const glm::vec3> seen_m, const LightFittingSettings& settings) {
    const std::vector<gpu::LightSample> drawn = draw_samples(pipeline);
    const LitSurface surface(drawn, settings.cell_m);
    if (surface.size() == 0) return {};
    const TryLampsInVolume try_lamps(pipeline, drawn, surface);
    return summarise(surface, search_lights(surface, try_lamps, seen_m, settings.search), settings);
}

}  // namespace patina
