#include "tests/reference/reflectance/refine_albedo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/reference/lighting/lamp_emission.h"

namespace patina::reference {

namespace {

constexpr double kClippedShare = 1e-3;

double mean_of(glm::dvec3 rgb) { return (rgb.r + rgb.g + rgb.b) / 3; }

/// An observation without its highlight.
struct Rest {
    glm::dvec3 diffuse;
    std::array<bool, 3> clipped{};
    double trust = 0;
    double robust = 1;

    double brightness() const { return mean_of(diffuse); }
    bool whole() const { return !clipped[0] && !clipped[1] && !clipped[2]; }
};

/// Where brightnesses lie, and their weighted mean distance from there.
struct Middle {
    double mean = 0, spread = 0;
};

/// Reweights three times, at first about the plain mean with a scale from the plain mean size.
Middle reweight(std::vector<Rest>& rests, double noise) {
    double mean = 0, scale = 0;
    for (const Rest& rest : rests) {
        mean += rest.brightness() / static_cast<double>(rests.size());
        scale += 1.5 * std::abs(rest.brightness()) / static_cast<double>(rests.size());
    }
    const auto share = [&](const Rest& rest) {
        return std::pow(1 + std::pow((rest.brightness() - mean) / (noise + scale), 2), -2);
    };
    for (int i = 0; i < 3; ++i) {
        double weights = 1e-20, sum = 0, spread = 0;
        for (const Rest& rest : rests) {
            const bool counts = rest.whole() || rest.brightness() >= mean - noise;
            const double weight = rest.trust * (counts ? 1 : kClippedShare) * share(rest);
            weights += weight;
            sum += weight * rest.brightness();
            spread += weight * std::abs(rest.brightness() - mean);
        }
        mean = sum / weights;
        scale = 1.5 * spread / weights;
    }
    for (Rest& rest : rests) rest.robust = share(rest);
    return {mean, scale / 1.5};
}

bool always_clipped(const std::vector<Rest>& rests, int channel) {
    return std::ranges::all_of(rests, [&](const Rest& rest) { return rest.clipped[static_cast<size_t>(channel)]; });
}

/// Half of what a channel that is always clipped is below a usual bright albedo by; where two are, all channels have
/// the largest.
glm::dvec3 brighter_by(glm::dvec3 kd, const std::vector<Rest>& rests) {
    glm::dvec3 by(0);
    int clipped = 0;
    for (int c = 0; c < 3; ++c) {
        if (!always_clipped(rests, c)) continue;
        ++clipped;
        by[c] = std::max((0.8 - kd[c]) / 2, 0.0);
    }
    return clipped < 2 ? by : glm::dvec3(std::max({by.r, by.g, by.b}));
}

/// What a clipped channel must not be below to count, by more than noise: the mean, in which clipped ones have next to
/// no share.
double bound_of(const std::vector<Rest>& rests, int channel) {
    double sum = 0, weights = 0;
    for (const Rest& rest : rests) {
        const double share =
            rest.trust * rest.robust * (rest.clipped[static_cast<size_t>(channel)] ? kClippedShare : 1);
        sum += share * rest.diffuse[channel];
        weights += share;
    }
    return sum / weights;
}

/// Of a mirror, whose views are so near each other that it shows the same in all: 1; from 5 degrees on 0.
double seen_from_one_side(const std::vector<SeenColor>& observations) {
    double least = 1;
    for (const SeenColor& seen : observations)
        least = std::min(least, glm::dot(seen.to_viewer, observations.front().to_viewer));
    const double t = std::clamp((least - 0.9962) / (0.9994 - 0.9962), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

}  // namespace

glm::dvec3 shade(const Ward& material, const SurfacePoint& point, const std::vector<ReceivedLight>& lights,
                 glm::dvec3 ambient, glm::dvec3 to_viewer) {
    glm::dvec3 sum = material.kd * ambient;
    for (const ReceivedLight& light : lights) {
        const glm::dvec3 offset = light.position_m - point.position_m;
        const double cosine = glm::dot(point.normal, glm::normalize(offset));
        if (!light.reaches || cosine <= 0) continue;
        sum += ward(material, point.normal, glm::normalize(offset), to_viewer) *
               emitted(light.intensity, light.axis, offset) * cosine / glm::dot(offset, offset);
    }
    return sum;
}

RefinedAlbedo refine_albedo(const std::vector<SeenColor>& observations, const SurfacePoint& point,
                            const std::vector<ReceivedLight>& lights, glm::dvec3 ambient, const Ward& material,
                            const GatheredRays& gathered, double mirror, glm::dvec3 low) {
    const Ward gloss{glm::dvec3(0), material.ks, material.alpha}, white{glm::dvec3(1), glm::dvec3(0), 1};
    double brightness = 0;
    std::vector<Rest> rests;
    std::vector<glm::dvec3> highlights;
    for (const SeenColor& seen : observations) {
        highlights.push_back(shade(gloss, point, lights, glm::dvec3(0), seen.to_viewer));
        const Rest rest{seen.rgb - highlights.back(), seen.clipped};
        brightness += rest.brightness() / static_cast<double>(observations.size());
        rests.push_back(rest);
    }
    const double noise = 0.002 + 0.02 * std::max(brightness, 0.0);
    for (size_t k = 0; k < rests.size(); ++k) {
        const double doubt = 0.5 * mean_of(highlights[k]) / noise;
        rests[k].trust = glm::dot(observations[k].to_viewer, point.normal) / (1 + doubt * doubt);
    }
    const Middle middle = reweight(rests, noise);
    const double rays = gathered.met + gathered.missed;
    glm::dvec3 around = ambient, around_error(0);
    double unreflected = 1;
    if (rays > 0) {
        around = (double(gathered.met) * gathered.mean + double(gathered.missed) * ambient) / rays;
        around_error = around * std::min(0.5 / std::sqrt(rays) + 0.3 * gathered.missed / rays, 1.0);
        const double spreads = 1.5 * (1 - mirror) + 8 * mirror;
        if (gathered.met > 0)
            unreflected = std::clamp(1 - spreads * std::max(middle.spread - noise, 0.0) / middle.mean, 0.0, 1.0) *
                          (1 - mirror * seen_from_one_side(observations));
    }
    const double mirrors = 1 - mirror + mirror * std::min((1 - unreflected) / 0.25, 1.0);
    const glm::dvec3 gloss_of_all = rays > 0 ? mirrors * material.ks * around : glm::dvec3(0);
    const glm::dvec3 irradiance = shade(white, point, lights, around, point.normal);
    std::vector<ReceivedLight> doubtful;
    for (ReceivedLight light : lights) {
        if (!light.uncertain) continue;
        light.reaches = true;
        doubtful.push_back(light);
    }
    const glm::dvec3 uncertain = shade(white, point, doubtful, glm::dvec3(0), point.normal);
    double trusted = 0, unclipped = 0;
    for (size_t k = 0; k < rests.size(); ++k) {
        const auto& clipped = observations[k].clipped;
        trusted += rests[k].trust;
        if (!clipped[0] && !clipped[1] && !clipped[2]) unclipped += rests[k].trust;
    }
    const double known = 1 - mirror + mirror * unclipped / trusted;
    glm::dvec3 diffuse(0), spreads(0);
    for (int c = 0; c < 3; ++c) {
        double weights = 0, squares = 0, sum = 0, spread = 0, robust_weights = 0;
        const double bound = bound_of(rests, c);
        for (const Rest& rest : rests) {
            const bool dark = rest.clipped[static_cast<size_t>(c)] && rest.diffuse[c] < bound - noise;
            const double robust = rest.trust * rest.robust, weight = robust * (dark ? kClippedShare : 1);
            weights += weight;
            squares += weight * weight;
            sum += weight * rest.diffuse[c];
            robust_weights += robust;
            spread += robust * std::pow(rest.brightness() - middle.mean, 2);
        }
        diffuse[c] = sum / weights;
        spreads[c] = noise * noise / weights + spread / robust_weights * squares / (weights * weights);
        spreads[c] *= 1 - mirror + mirror * unreflected * unreflected;
    }
    bool low_tells = false;
    for (int c = 0; c < 3; ++c) low_tells = low_tells || (always_clipped(rests, c) && low[c] > diffuse[c]);
    if (low_tells) diffuse = low;
    RefinedAlbedo result;
    for (int c = 0; c < 3; ++c)
        if (irradiance[c] > 0.004)
            result.kd[c] = std::clamp(unreflected * (diffuse[c] - gloss_of_all[c]) / irradiance[c], 0.0, 1.0);
    const glm::dvec3 brighter = brighter_by(result.kd, rests);
    for (int c = 0; c < 3; ++c) {
        if (irradiance[c] <= 0.004) continue;
        const double doubt = result.kd[c] * std::min(uncertain[c] / irradiance[c], 1.0);
        const double error = 0.3 * std::min(around_error[c] / irradiance[c], 1.0);
        const double clipped = low_tells ? 0 : std::max(always_clipped(rests, c) ? 0.1 : 0.0, brighter[c]);
        const double all =
            spreads[c] / (irradiance[c] * irradiance[c]) + doubt * doubt + error * error + clipped * clipped;
        result.certainty[c] = known / (1 + all / (0.05 * 0.05));
    }
    return result;
}

}  // namespace patina::reference
