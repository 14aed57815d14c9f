#include "tests/reference/fit_ward.h"

#include <algorithm>
#include <cmath>

namespace patina::reference {

namespace {

/// One channel of all voxels, for one alpha: residuals are color - ks * lobe, each without its voxel's weighted mean.
struct Line {
    double lobe2 = 0, product = 0, color2 = 0;
};

constexpr double kLeast = 0.02, kMost = 0.6;

bool is_flat(const FittedVoxel& voxel, const SeenColor& seen) {
    return glm::dot(seen.to_viewer, voxel.point.normal) < 0.15;
}

/// What all of a voxel's observations weigh.
double weight_of(const FittedVoxel& voxel) {
    double brightness = 0, count = 0;
    for (const SeenColor& seen : voxel.observations) {
        if (is_flat(voxel, seen)) continue;
        brightness += (seen.rgb.r + seen.rgb.g + seen.rgb.b) / 3;
        ++count;
    }
    return count > 0 ? std::pow(0.004 + 0.05 * brightness / count, -2) : 0;
}

void add(Line& line, const FittedVoxel& voxel, double alpha, int channel) {
    const Ward gloss{glm::dvec3(0), glm::dvec3(1), std::sqrt(alpha * alpha + voxel.blur2)};
    const double weight = weight_of(voxel);
    std::vector<double> lobe, color;
    double lobe_sum = 0, color_sum = 0;
    for (const SeenColor& seen : voxel.observations) {
        if (seen.clipped[static_cast<size_t>(channel)] || is_flat(voxel, seen)) continue;
        lobe.push_back(shade(gloss, voxel.point, voxel.lights, glm::dvec3(0), seen.to_viewer)[channel]);
        color.push_back(seen.rgb[channel]);
        lobe_sum += lobe.back();
        color_sum += color.back();
    }
    const double count = static_cast<double>(lobe.size());
    for (size_t k = 0; k < lobe.size(); ++k) {
        const double l = lobe[k] - lobe_sum / count, c = color[k] - color_sum / count;
        line.lobe2 += weight * l * l;
        line.product += weight * l * c;
        line.color2 += weight * c * c;
    }
}

struct Solution {
    glm::dvec3 ks{0};
    double score = 0;  ///< -2 log of how likely the alpha is, times the prior's unit
};

Solution solve(const std::vector<FittedVoxel>& voxels, const SpecularPrior& prior, double alpha) {
    Solution best;
    best.score = prior.alpha_weight * std::pow(std::log2(alpha / prior.alpha), 2);
    for (int c = 0; c < 3; ++c) {
        Line line;
        for (const FittedVoxel& voxel : voxels) add(line, voxel, alpha, c);
        const double bend = line.lobe2 + prior.ks_weight;
        if (bend > 0) best.ks[c] = std::max((line.product + prior.ks_weight * prior.ks[c]) / bend, 0.0);
        best.score += line.color2 - 2 * best.ks[c] * line.product + std::pow(best.ks[c], 2) * line.lobe2 +
                      prior.ks_weight * std::pow(best.ks[c] - prior.ks[c], 2);
        // The integral over ks of a normal distribution is as its width.
        best.score += prior.unit * std::log(bend / prior.ks_weight);
    }
    return best;
}

}  // namespace

Ward fit_ward(const std::vector<FittedVoxel>& voxels, const SpecularPrior& prior) {
    // So fine that sums are integrals.
    constexpr int kSteps = 500;
    std::vector<Solution> all;
    for (int i = 0; i <= kSteps; ++i)
        all.push_back(solve(voxels, prior, kMost * std::pow(kLeast / kMost, static_cast<double>(i) / kSteps)));
    const double least = std::ranges::min(all, {}, &Solution::score).score;
    double sum = 0, place = 0;
    glm::dvec3 ks(0);
    for (int i = 0; i <= kSteps; ++i) {
        const Solution& at = all[static_cast<size_t>(i)];
        const double likely = std::exp((least - at.score) / (2 * prior.unit));
        sum += likely;
        place += likely * i;
        ks += likely * at.ks;
    }
    return {glm::dvec3(0), ks / sum, kMost * std::pow(kLeast / kMost, place / sum / kSteps)};
}

}  // namespace patina::reference
