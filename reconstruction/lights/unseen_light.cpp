#include "reconstruction/lights/unseen_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <ranges>
#include <utility>
#include <vector>

#include "reconstruction/lights/light_fitting.h"
#include "reconstruction/lights/surface_samples.h"
#include "shared/lighting/lights.h"

namespace patina {
namespace {

constexpr double kWellExplained = 0.06;  // scenes of lamps and sky have 0.03 to 0.05
constexpr double kMostMisfit = 0.15;     // rooms have 0.08 to 0.15, one with patches of sun 0.22
constexpr double kMostOfFit = 0.1;       // of what is fitted
constexpr std::array kShares = {0.0, 0.125, 0.25, 0.375, 0.5, 0.75, 1.0, 1.25, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0};
constexpr uint32_t kHalvings = 3;                  // of the step between shares, around the best
constexpr double kDarker = 0.05, kBrighter = 0.5;  // how unlikely it is that unknown directions are
constexpr double kNoMisfit = 0.005;                // surface that is explained well has more
constexpr float kLeastUnseen = 1e-4f;
constexpr float kBrightestAlbedo = 0.9f;   // of white paint; few things have more
constexpr ptrdiff_t kLeastSamples = 1024;  // rooms have 2400 after 4 frames, a table has 960, a shelf 320 in the end
constexpr float kLeastReach = 0.02f;       // share of directions, below which unseen light is no explanation

float mean_of(const auto& rgb) { return (rgb.r + rgb.g + rgb.b) / 3; }

/// Without those of highlights, which follow.
std::span<const gpu::LightSample> of_surface(std::span<const gpu::LightSample> drawn) {
    return drawn.first(std::min<size_t>(drawn.size(), gpu::kLightSamples));
}

/// Of which it was looked what is around them.
auto looked_around(std::span<const gpu::LightSample> samples) {
    return of_surface(samples) |
           std::views::filter([](const gpu::LightSample& s) { return s.point_m.w > 0 && s.around.w >= 0; });
}

/// What light of 1 from unknown directions gives each sample; 0 where that is less than `least`, or nobody looked.
std::vector<float> reached_by_unseen(std::span<const gpu::LightSample> samples, float least) {
    std::vector<float> reached;
    for (const gpu::LightSample& sample : samples)
        reached.push_back(sample.point_m.w > 0 && sample.around.w >= least ? sample.around.w : 0);
    return reached;
}

/// What light leaves that is known, as what `ambient` gives the samples (null: the same everywhere).
std::optional<float> left_over(const LitSurface& surface, const ReceivedLight& known, const ReceivedLight& ambient) {
    const FittedIntensities fitted =
        surface.fit(std::span(&known, 1), kIntensitySteps, surface.size(), LightChannel::kMean, ambient);
    const double explained = fitted.intensities[0], rest = fitted.intensities[1];
    if (!(explained > 0) || fitted.misfit > kMostOfFit) return std::nullopt;
    return static_cast<float>(rest / explained);
}

/// What a share adds to the misfit, relative.
double unlikelihood(double share) {
    if (share <= 1) return kDarker * (1 - share) * (1 - share);
    return kBrighter * std::log(share) * std::log(share);
}

}  // namespace

ReceivedLight with_unseen(const KnownLight& known, double unseen) {
    ReceivedLightValues sum = *known.all;
    for (size_t i = 0; i < sum.by_sample.size(); ++i)
        sum.by_sample[i] += static_cast<float>(unseen) * known.unknown->by_sample[i];
    sum.mean += unseen * known.unknown->mean;
    return std::make_shared<const ReceivedLightValues>(std::move(sum));
}

UnseenLight likely_unseen_light(const LitSurface& surface, const KnownLight& known, double usual,
                                std::span<const ReceivedLight> lamps) {
    const ReceivedLight none = surface.received(std::vector<float>(gpu::kLightSamples));
    std::vector<ReceivedLight> lights(lamps.begin(), lamps.end());
    lights.emplace_back();
    double best = 1, misfit = 1, least = 1e9;
    const auto consider = [&](double share) {
        lights.back() = with_unseen(known, share * usual);
        if (!(lights.back()->mean > 0)) return;
        const double left = surface.fit(lights, kIntensitySteps, surface.size(), LightChannel::kMean, none).misfit;
        const double cost = (kNoMisfit + left) * (1 + unlikelihood(share));
        if (cost < least) best = share, misfit = left, least = cost;
    };
    for (const double share : kShares) consider(share);
    const auto at = std::ranges::find(kShares, best);
    double below = at == kShares.begin() ? 0 : *at - *std::prev(at);
    double above = std::next(at) == kShares.end() ? 0 : *std::next(at) - *at;
    for (uint32_t i = 0; i < kHalvings; ++i) {
        below /= 2;
        above /= 2;
        const double middle = best;
        consider(middle - below);
        consider(middle + above);
    }
    return {best * usual, misfit};
}

std::optional<float> fit_unseen_light(const LitSurface& surface, const KnownLight& known) {
    const std::optional<float> everywhere = left_over(surface, known.lamps, nullptr);
    const std::optional<float> unknown = left_over(surface, known.all, known.unknown);
    if (!everywhere || !unknown) return everywhere ? everywhere : unknown;
    return std::min(*everywhere, *unknown);
}

glm::vec3 usual_light(std::span<const gpu::LightSample> samples) {
    glm::dvec3 sum(0);
    double known = 0;
    for (const gpu::LightSample& sample : samples) {
        if (!(sample.point_m.w > 0) || sample.around.w < 0) continue;
        sum += glm::dvec3(sample.around);
        known += 1 - double{sample.around.w};
    }
    return known > 0 ? glm::vec3(sum / known) : glm::vec3(0);
}

double unknown_share(std::span<const gpu::LightSample> samples) {
    double sum = 0, count = 0;
    for (const gpu::LightSample& sample : looked_around(samples)) {
        sum += double{sample.around.w};
        count += 1;
    }
    return count > 0 ? sum / count : 1;
}

bool is_enough_surface(std::span<const gpu::LightSample> samples) {
    return std::ranges::distance(looked_around(samples)) >= kLeastSamples;
}

bool is_enough_around(std::span<const gpu::LightSample> samples) { return unknown_share(samples) < kHardlyKnown; }

glm::vec3 surface_light(std::span<const gpu::LightSample> samples) {
    samples = of_surface(samples);
    glm::vec3 light(0);
    for (int c = 0; c < 3; ++c) {
        std::vector<float> sent;
        for (const gpu::LightSample& sample : samples)
            if (sample.point_m.w > 0) sent.push_back(sample.diffuse[c]);
        if (sent.empty()) continue;
        const auto middle = sent.begin() + static_cast<ptrdiff_t>(sent.size() / 2);
        std::nth_element(sent.begin(), middle, sent.end());
        light[c] = *middle;
    }
    return light;
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
    samples = of_surface(samples);
    const std::vector<float> reached = reached_by_unseen(samples, kLeastReach);
    return std::max(least_strength(samples, received, reached, kBrightestAlbedo, kBrighterShare).value_or(0), 0.0f);
}

float most_unseen_light(std::span<const gpu::LightSample> samples, std::span<const float> received,
                        float white_albedo) {
    samples = of_surface(samples);
    const std::vector<float> reached = reached_by_unseen(samples, 0);
    const auto strength = least_strength(samples, received, reached, kDarkWhite * white_albedo, kBrightest);
    return std::max(strength.value_or(std::numeric_limits<float>::infinity()), 0.0f);
}

std::optional<glm::vec3> choose_unseen_light(const LitSurface& surface, const KnownLight& known, glm::vec3 usual,
                                             bool beside_sun) {
    const UnseenLight likely = likely_unseen_light(surface, known, double{mean_of(usual)});
    if (likely.misfit > kMostMisfit) return std::nullopt;
    const auto fitted = likely.misfit < kWellExplained ? fit_unseen_light(surface, known) : std::nullopt;
    if (!fitted) return static_cast<float>(likely.radiance) / mean_of(usual) * usual;
    // What is not modelled of a sun (soft borders, gloss) would be taken for such light.
    return glm::vec3(beside_sun ? 0 : *fitted);
}

glm::vec3 decide_unseen_light(const std::optional<glm::vec3>& chosen, std::span<const gpu::LightSample> drawn,
                              UnseenLightBounds bounds) {
    const glm::vec3 light = chosen ? *chosen : surface_light(drawn);
    const float radiance = mean_of(light), least = chosen ? bounds.least : 0;
    const float bounded = std::max({std::min(radiance, bounds.most), least, kLeastUnseen});
    if (bounded == radiance) return light;
    return radiance > 0 ? bounded / radiance * light : glm::vec3(bounded);
}

std::optional<glm::vec3> find_unseen_light(Pipeline& pipeline, std::vector<gpu::LightSample> drawn,
                                           std::span<const Light> lights, std::optional<float> white_albedo) {
    for (gpu::LightSample& sample : drawn)
        if (sample.around.w < 0) sample.point_m.w = 0;  // nobody looked what is around it
    const LitSurface surface(drawn, LightFittingSettings().cell_m);
    if (surface.size() == 0 || usual_light(drawn) == glm::vec3(0)) return std::nullopt;
    const std::vector<glm::vec3> received = received_from(pipeline, drawn, lights);
    std::vector<float> sent, all, unknown;
    for (size_t i = 0; i < gpu::kLightSamples; ++i) {
        sent.push_back(mean_of(received[i]));
        all.push_back(sent.back() + mean_of(drawn[i].around));
        unknown.push_back(drawn[i].around.w);
    }
    const KnownLight known{surface.received(sent), surface.received(all), surface.received(unknown)};
    const auto chosen = choose_unseen_light(surface, known, usual_light(drawn), std::ranges::any_of(lights, is_sun));
    if (!chosen && lights.empty() && white_albedo) return std::nullopt;
    UnseenLightBounds bounds{.least = least_unseen_light(drawn, all)};
    if (white_albedo) bounds.most = most_unseen_light(drawn, all, *white_albedo);
    return decide_unseen_light(chosen, drawn, bounds);
}

}  // namespace patina
