#include "reconstruction/lights/unmeasured_lamps.h"

#include <algorithm>
#include <cmath>

#include "engine/core/shader_light.h"
#include "reconstruction/lights/light_fitting.h"
#include "reconstruction/lights/surface_samples.h"
#include "reconstruction/lights/try_in_volume.h"
#include "reconstruction/lights/unseen_light.h"
#include "shared/lighting/lights.h"

namespace patina {
namespace {

constexpr double kMostUnexplained = 0.125;  // a room whose lamps were found had 0.09 to 0.12, one with a sun 0.25
constexpr float kBrightWhite = 1.125f;      // of the albedo of white surfaces
constexpr double kLeastKnownShare = 0.05;   // of all light, to tell how bright the rest is
constexpr double kOwnTint = 0.5;            // of what the surface tells; the rest is other lamps'
constexpr double kLeastScale = 0.05;        // of what was fitted
constexpr float kExpectedGain = 0.06f;      // LightSearchSettings
constexpr double kKnownAround = 0.35;       // share of light that comes from unknown directions

/// Whether the median of its sightings is a lower bound.
bool is_clipped(const FoundLight& lamp) {
    return lamp.evidence.clipped > 0 && 2 * lamp.evidence.clipped >= lamp.evidence.sightings;
}

float mean_of(glm::vec3 rgb) { return (rgb.r + rgb.g + rgb.b) / 3; }

ReceivedLight received_in(const LitSurface& surface, std::span<const glm::vec3> light, LightChannel channel) {
    std::vector<float> row;
    row.reserve(light.size());
    for (const glm::vec3& rgb : light)
        row.push_back(channel == LightChannel::kMean ? mean_of(rgb) : rgb[static_cast<int>(channel)]);
    return surface.received(row);
}

/// Light beside what is known.
struct Unmeasured {
    std::vector<double> intensities;  // of lamps
    double misfit = 0;
    bool has_scale = false;  // else they are right up to one factor
};

Unmeasured fit_beside(const ReceivedLight& known, const LitSurface& surface, std::span<const ReceivedLight> lamps,
                      LightChannel channel) {
    std::vector<ReceivedLight> lights(lamps.begin(), lamps.end());
    lights.push_back(known);
    const ReceivedLight none = surface.received(std::vector<float>(gpu::kLightSamples));
    const FittedIntensities fitted = surface.fit(lights, kIntensitySteps, surface.size(), channel, none);
    // The mean sample receives 1 of all lights together.
    const double factor = fitted.intensities[lamps.size()];
    const bool has_scale = factor * known->mean > kLeastKnownShare;
    Unmeasured result{.intensities = fitted.intensities, .misfit = fitted.misfit, .has_scale = has_scale};
    result.intensities.resize(lamps.size());
    if (has_scale)
        for (double& intensity : result.intensities) intensity /= factor;
    return result;
}

/// Mean of the channels by sample.
std::vector<float> light_of(const Unmeasured& unmeasured, std::span<const ReceivedLight> lamps, size_t samples) {
    std::vector<float> light(samples);
    for (size_t i = 0; i < samples; ++i) {
        double sum = 0;
        for (size_t l = 0; l < lamps.size(); ++l) sum += unmeasured.intensities[l] * lamps[l]->by_sample[i];
        light[i] = static_cast<float>(sum);
    }
    return light;
}

/// Whether a lamp that was found is where one was found before.
bool is_where_one_was(const TrialLamp& lamp, std::span<const glm::vec3> before_m, const LitSurface& surface) {
    return std::ranges::any_of(before_m, [&](glm::vec3 m) { return is_same_place(surface, lamp.place_m, m); });
}

/// How much is known of what is around, 0 to 1.
double sureness(const ReceivedLight& unknown) {
    return std::clamp((kHardlyKnown - unknown->mean) / (kHardlyKnown - kKnownAround), 0.0, 1.0);
}

}  // namespace

UnmeasuredLamps fit_unmeasured_lamps(const LitSurface& surface, const MeasuredLight& measured,
                                     std::span<const TrialLamp> clipped, std::span<const glm::vec3> before_m,
                                     const TryLamps& try_lamps, uint32_t most_added) {
    UnmeasuredLamps result;
    if (surface.size() == 0) return result;
    const ReceivedLight unknown = surface.received(measured.unknown);
    const auto known_in = [&](LightChannel channel) {
        return KnownLight{.lamps = {}, .all = received_in(surface, measured.known, channel), .unknown = unknown};
    };
    const KnownLight known = known_in(LightChannel::kMean);
    const double usual = mean_of(measured.usual);
    const GivenLight given{{known.all}, unknown, {clipped.begin(), clipped.end()}};
    // Most highlights are of lamps that pictures show.
    const std::vector<TrialLamp> all =
        search_lights(surface, try_lamps, before_m,
                      {.most_lamps = most_added, .highlight_share = 0, .expected_gain = kExpectedGain}, given);
    const auto of_clipped = std::span(all).first(clipped.size()), found = std::span(all).subspan(clipped.size());
    for (const TrialLamp& lamp : found) result.places_m.push_back(lamp.place_m);
    std::vector<TrialLamp> told(of_clipped.begin(), of_clipped.end());
    for (const TrialLamp& lamp : found)
        if (sureness(unknown) == 1 || is_where_one_was(lamp, before_m, surface)) told.push_back(lamp);
    std::vector<ReceivedLight> lamps;
    for (const TrialLamp& lamp : told) lamps.push_back(lamp.received);
    if (lamps.empty()) return result;
    const double unseen = likely_unseen_light(surface, known, usual, lamps).radiance;
    const ReceivedLight beside = with_unseen(known, unseen);
    const Unmeasured fitted = fit_beside(beside, surface, lamps, LightChannel::kMean);
    if (fitted.misfit > kMostUnexplained) return result;

    const double sure = fitted.has_scale ? sureness(unknown) : 0;
    const std::vector<float> light = light_of(fitted, lamps, surface.size());
    const auto scale_of = [&](float albedo, double share) {
        const auto scale = least_strength(surface.samples(), beside->by_sample, light, albedo, share);
        return std::max<double>(scale.value_or(1), kLeastScale);
    };
    const float white = measured.white_albedo;
    const double sure_of_scale = measured.low_exposure ? sure : 0;
    const double plausible = fitted.has_scale
                                 ? std::pow(std::min(scale_of(kDarkWhite * white, kBrightest), 1.0), 1 - sure_of_scale)
                                 : scale_of(white, kBrightest);
    const double scale = std::max(scale_of(kBrightWhite * white, kBrighterShare), plausible);
    std::vector<glm::dvec3> intensities(lamps.size());
    for (int c = 0; c < 3; ++c) {
        const auto channel = static_cast<LightChannel>(c);
        const Unmeasured own =
            fit_beside(with_unseen(known_in(channel), usual > 0 ? unseen / usual * double{measured.usual[c]} : 0),
                       surface, lamps, channel);
        for (size_t l = 0; l < lamps.size(); ++l)
            intensities[l][c] = scale * std::lerp(measured.tint[c] * fitted.intensities[l], own.intensities[l],
                                                  own.has_scale ? kOwnTint * sure : 0);
    }
    for (size_t l = 0; l < told.size(); ++l)
        (l < clipped.size() ? result.clipped : result.added)
            .push_back({.position_m = glm::dvec3(told[l].place_m),
                        .intensity = intensities[l],
                        .axis = glm::dvec3(told[l].axis)});
    return result;
}

ToldLamps find_unmeasured_lamps(Pipeline& pipeline, std::vector<gpu::LightSample> drawn,
                                std::span<const FoundLight> lamps, std::span<const glm::vec3> before_m,
                                float white_albedo, bool low_exposure) {
    for (gpu::LightSample& sample : drawn)
        if (sample.around.w < 0) sample.point_m.w = 0;  // nobody looked what is around it
    std::vector<Light> sure, clipped;
    for (const FoundLight& lamp : lamps) (is_clipped(lamp) ? clipped : sure).push_back(lamp.light);

    MeasuredLight measured{.known = received_from(pipeline, drawn, sure),
                           .unknown = {},
                           .white_albedo = white_albedo,
                           .low_exposure = low_exposure};
    std::vector<float> brightness;
    for (size_t i = 0; i < gpu::kLightSamples; ++i) {
        measured.known[i] += glm::vec3(drawn[i].around);
        measured.unknown.push_back(drawn[i].around.w);
        brightness.push_back(mean_of(measured.known[i]));
    }
    measured.usual = usual_light(drawn);
    ToldLamps all{.lamps = std::vector(lamps.begin(), lamps.end()),
                  .places_m = std::vector(before_m.begin(), before_m.end())};
    if (clipped.empty() && least_unseen_light(drawn, brightness) <= 0) return all;
    glm::vec3 together(0);
    for (const Light& lamp : sure) together += glm::vec3(lamp.intensity);
    if (mean_of(together) > 0) measured.tint = together / mean_of(together);

    // Most highlights are of lamps that pictures show: no ray is marched for them.
    for (gpu::LightSample& sample : std::span(drawn).subspan(gpu::kLightSamples)) sample.highlight.w = 0;
    const LitSurface surface(drawn, LightFittingSettings().cell_m);
    const RuledOutPlaces ruled_out(pipeline, pipeline.reflectance()->low_exposure_cameras());
    const TryLampsInVolume try_known(pipeline, drawn, surface), try_unseen(pipeline, drawn, surface, &ruled_out);
    std::vector<glm::vec3> places_m;
    for (const Light& lamp : clipped) places_m.emplace_back(lamp.position_m);
    const std::vector<TrialLamp> of_clipped = try_known(places_m, gpu::kLightSamples);
    const auto room =
        static_cast<uint32_t>(gpu::kMaxPointLights - std::min<size_t>(lamps.size(), gpu::kMaxPointLights));
    const UnmeasuredLamps told = fit_unmeasured_lamps(surface, measured, of_clipped, before_m, try_unseen,
                                                      std::min(room, LightSearchSettings().most_lamps));
    all.places_m.insert(all.places_m.end(), told.places_m.begin(), told.places_m.end());
    size_t next = 0;
    for (FoundLight& lamp : all.lamps) {
        if (!is_clipped(lamp) || told.clipped.empty()) continue;
        lamp.evidence.shown = lamp.light.intensity;
        lamp.light.intensity = glm::max(lamp.light.intensity, told.clipped[next].intensity);
        lamp.light.axis = told.clipped[next++].axis;
    }
    for (const Light& lamp : told.added) all.lamps.push_back({lamp, {.unseen = true}});
    for (FoundLight& lamp : all.lamps) lamp.light = rounded_to_float(lamp.light);
    return all;
}

std::vector<FoundLight> as_measured(std::vector<FoundLight> lamps) {
    std::erase_if(lamps, [](const FoundLight& lamp) { return is_sun(lamp.light) || lamp.evidence.unseen; });
    for (FoundLight& lamp : lamps) {
        if (lamp.evidence.shown == glm::dvec3(0)) continue;
        lamp.light.intensity = lamp.evidence.shown;
        lamp.light.axis = glm::dvec3(0);
        lamp.evidence.shown = glm::dvec3(0);
    }
    return lamps;
}

}  // namespace patina
