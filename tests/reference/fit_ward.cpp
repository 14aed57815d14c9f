#include "tests/reference/fit_ward.h"

#include <algorithm>
#include <cmath>

namespace patina::reference {

namespace {

/// One channel of all voxels, for one alpha: residuals are color - ks * lobe, each without its voxel's weighted mean.
struct Line {
    double lobe2 = 0, product = 0, color2 = 0;
};

double variance(glm::dvec3 rgb) { return std::pow(0.004 + 0.05 * (rgb.r + rgb.g + rgb.b) / 3, 2); }

void add(Line& line, const FittedVoxel& voxel, double alpha, int channel) {
    const Ward gloss{glm::dvec3(0), glm::dvec3(1), alpha};
    std::vector<double> weight, lobe, color;
    double sum = 0, lobe_mean = 0, color_mean = 0;
    for (const SeenColor& seen : voxel.observations) {
        if (seen.clipped[static_cast<size_t>(channel)] || glm::dot(seen.to_viewer, voxel.point.normal) < 0.15) continue;
        weight.push_back(1 / variance(seen.rgb));
        lobe.push_back(shade(gloss, voxel.point, voxel.lights, glm::dvec3(0), seen.to_viewer)[channel]);
        color.push_back(seen.rgb[channel]);
        sum += weight.back();
        lobe_mean += weight.back() * lobe.back();
        color_mean += weight.back() * color.back();
    }
    for (size_t k = 0; k < weight.size(); ++k) {
        const double l = lobe[k] - lobe_mean / sum, c = color[k] - color_mean / sum;
        line.lobe2 += weight[k] * l * l;
        line.product += weight[k] * l * c;
        line.color2 += weight[k] * c * c;
    }
}

struct Solution {
    glm::dvec3 ks{0};
    double cost = 0;
};

Solution solve(const std::vector<FittedVoxel>& voxels, const SpecularPrior& prior, double alpha) {
    Solution best;
    best.cost = prior.alpha_weight * std::pow(std::log2(alpha / prior.alpha), 2);
    for (int c = 0; c < 3; ++c) {
        Line line;
        for (const FittedVoxel& voxel : voxels) add(line, voxel, alpha, c);
        const double bend = line.lobe2 + prior.ks_weight;
        if (bend > 0) best.ks[c] = std::max((line.product + prior.ks_weight * prior.ks[c]) / bend, 0.0);
        best.cost += line.color2 - 2 * best.ks[c] * line.product + std::pow(best.ks[c], 2) * line.lobe2 +
                     prior.ks_weight * std::pow(best.ks[c] - prior.ks[c], 2);
    }
    return best;
}

}  // namespace

Ward fit_ward(const std::vector<FittedVoxel>& voxels, const SpecularPrior& prior) {
    constexpr double kFinest = 1e-5, kLeast = 0.02, kMost = 0.6;
    const auto cost = [&](double log_alpha) { return solve(voxels, prior, std::exp(log_alpha)).cost; };
    double at = std::log(kMost), step = std::log(1.1);
    double least = cost(at);
    for (double x = at; x > std::log(kLeast); x -= step) {
        if (const double there = cost(x); there < least) {
            least = there;
            at = x;
        }
    }
    for (; step > kFinest; step /= 2) {
        for (const double x : {at - step, at + step}) {
            if (const double there = cost(x); there < least) {
                least = there;
                at = x;
            }
        }
    }
    return {glm::dvec3(0), solve(voxels, prior, std::exp(at)).ks, std::exp(at)};
}

}  // namespace patina::reference
