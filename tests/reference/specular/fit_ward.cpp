#include "tests/reference/specular/fit_ward.h"

#include <algorithm>
#include <cmath>

namespace patina::reference {

namespace {

// So fine that sums are integrals.
constexpr int kSteps = 500;
constexpr double kLeast = 0.02, kMost = 0.6;

double alpha_of(double step) { return kMost * std::pow(kLeast / kMost, step / kSteps); }

double mean_of(glm::dvec3 v) { return (v.x + v.y + v.z) / 3; }
double max_of(glm::dvec3 v) { return std::max({v.x, v.y, v.z}); }

glm::dvec3 lobe_of(const FittedVoxel& voxel, double alpha, const SeenColor& seen) {
    const Ward gloss{glm::dvec3(0), glm::dvec3(1), std::sqrt(alpha * alpha + voxel.blur2)};
    return shade(gloss, voxel.point, voxel.lights, glm::dvec3(0), seen.to_viewer);
}

/// 1 if a view of the voxel lies within half of the peak of a light's lobe as it is seen, less farther off; whether or
/// not it is clipped.
double peak_seen(const FittedVoxel& voxel, double alpha) {
    const double seen_alpha2 = alpha * alpha + voxel.blur2;
    double most = 0;
    for (const SeenColor& seen : voxel.observations) {
        for (const ReceivedLight& light : voxel.lights) {
            const glm::dvec3 to_light = glm::normalize(light.position_m - voxel.point.position_m);
            if (glm::dot(to_light, voxel.point.normal) <= 0) continue;
            const double cosine = glm::dot(glm::normalize(to_light + seen.to_viewer), voxel.point.normal);
            const double tan2 = 1 / (cosine * cosine) - 1;
            most = std::max(most, alpha * alpha / seen_alpha2 * std::exp(-tan2 / seen_alpha2));
        }
    }
    return std::min(most / 0.5, 1.0);
}

/// The weighted mean of what counts.
struct Mean {
    double sum = 0, weight = 0;
    void add(double value, double by) {
        sum += by * value;
        weight += by;
    }
    double value() const { return weight > 0 ? sum / weight : 0; }
};

}  // namespace

/// A voxel with the observations that are not flat, and what each weighs.
struct WardFitSeries::Weighed {
    FittedVoxel voxel;
    std::vector<double> weights;
};

WardFitSeries::WardFitSeries(const SpecularPrior& prior, glm::dvec3 ambient)
    : prior_(prior), ambient_(ambient), lines_(kSteps + 1), seen_(kSteps + 1), solutions_(kSteps + 1) {}

/// An inverse variance: what all of a voxel's observations have in common, and a part of the highlight that the
/// estimate predicts; less, by Geman and McClure, of what is far off it, unless a channel is clipped.
WardFitSeries::Weighed WardFitSeries::weigh(const FittedVoxel& voxel) const {
    Weighed result{voxel, {}};
    std::vector<SeenColor>& seen = result.voxel.observations;
    std::erase_if(seen, [&](const SeenColor& each) { return glm::dot(each.to_viewer, voxel.point.normal) < 0.15; });
    double brightness = 0;
    for (const SeenColor& each : seen) brightness += mean_of(each.rgb) / static_cast<double>(seen.size());
    std::vector<glm::dvec3> rest;
    for (const SeenColor& each : seen) {
        const glm::dvec3 highlight = fits_ == 0 ? glm::dvec3(0) : estimate_.ks * lobe_of(voxel, estimate_.alpha, each);
        rest.push_back(each.rgb - highlight);
        result.weights.push_back(1 / (std::pow(0.004 + 0.05 * brightness, 2) + std::pow(0.3 * mean_of(highlight), 2)));
    }
    if (confidence_ < 0.5 || max_of(estimate_.ks) <= 0.01) return result;

    const std::vector<double> trust = result.weights;
    const auto means = [&](const std::vector<std::array<bool, 3>>& counts) {
        std::array<Mean, 3> mean;
        for (size_t k = 0; k < seen.size(); ++k) {
            for (size_t c = 0; c < 3; ++c)
                if (counts[k][c]) mean[c].add(rest[k][static_cast<int>(c)], result.weights[k]);
        }
        return mean;
    };
    std::vector<std::array<bool, 3>> counts;
    for (const SeenColor& each : seen) counts.push_back({!each.clipped[0], !each.clipped[1], !each.clipped[2]});
    const std::array<Mean, 3> unclipped = means(counts);
    for (size_t k = 0; k < seen.size(); ++k) {
        for (size_t c = 0; c < 3; ++c) {
            const bool brighter = rest[k][static_cast<int>(c)] > unclipped[c].value();
            counts[k][c] = counts[k][c] || (unclipped[c].weight > 0 && brighter);
        }
    }
    for (int step = 0; step < 2; ++step) {
        const std::array<Mean, 3> mean = means(counts);
        for (size_t k = 0; k < seen.size(); ++k) {
            if (std::ranges::count(seen[k].clipped, true) > 0) continue;
            double off2 = 0, channels = 0;
            for (size_t c = 0; c < 3; ++c) {
                if (!counts[k][c]) continue;
                off2 += std::pow(rest[k][static_cast<int>(c)] - mean[c].value(), 2);
                ++channels;
            }
            const double scale = 2 * std::max(deviation_, 1.0);
            const double far2 = off2 * trust[k] / (scale * scale) / std::max(channels, 1.0);
            result.weights[k] = trust[k] / ((1 + far2) * (1 + far2));
        }
    }
    return result;
}

std::array<WardFitSeries::Line, 3> WardFitSeries::sum(const std::vector<Weighed>& voxels, size_t step) const {
    const double alpha = alpha_of(static_cast<double>(step));
    std::array<Line, 3> lines{};
    for (const Weighed& weighed : voxels) {
        const std::vector<SeenColor>& seen = weighed.voxel.observations;
        std::vector<glm::dvec3> lobes;
        for (const SeenColor& each : seen) lobes.push_back(lobe_of(weighed.voxel, alpha, each));
        for (int c = 0; c < 3; ++c) {
            const auto clipped = [&](size_t k) { return seen[k].clipped[static_cast<size_t>(c)]; };
            Mean lobe, color;
            for (size_t k = 0; k < seen.size(); ++k) {
                if (clipped(k)) continue;
                lobe.add(lobes[k][c], weighed.weights[k]);
                color.add(seen[k].rgb[c], weighed.weights[k]);
            }
            std::vector<size_t> counted;
            for (size_t k = 0; k < seen.size(); ++k) {
                const double predicted = color.value() + solutions_[step].ks[c] * (lobes[k][c] - lobe.value());
                if (!clipped(k) || (fits_ > 0 && lobe.weight > 0 && seen[k].rgb[c] > predicted)) counted.push_back(k);
            }
            Mean all_lobes, all_colors;
            for (const size_t k : counted) {
                all_lobes.add(lobes[k][c], weighed.weights[k]);
                all_colors.add(seen[k].rgb[c], weighed.weights[k]);
            }
            Line& line = lines[static_cast<size_t>(c)];
            for (const size_t k : counted) {
                const double l = lobes[k][c] - all_lobes.value(), v = seen[k].rgb[c] - all_colors.value();
                line.lobe2 += weighed.weights[k] * l * l;
                line.product += weighed.weights[k] * l * v;
                line.color2 += weighed.weights[k] * v * v;
                ++line.count;
            }
        }
    }
    return lines;
}

WardFitSeries::Solution WardFitSeries::solve(size_t step) const {
    const double alpha = alpha_of(static_cast<double>(step));
    // Of a peak that two voxels or fewer were seen near nothing is known, from six on all.
    const double known = std::clamp((seen_[step] - 2) / 4, 0.0, 1.0);
    Solution result;
    result.score = unit_ * std::pow(std::log2(alpha / prior_.alpha) / prior_.alpha_deviation, 2);
    const double weight = unit_ / (prior_.ks_deviation * prior_.ks_deviation);
    for (int c = 0; c < 3; ++c) {
        const Line& line = lines_[step][static_cast<size_t>(c)];
        const double lobe2 = known * line.lobe2, product = known * line.product, bend = lobe2 + weight;
        const double ks = std::max((product + weight * prior_.ks[c]) / bend, 0.0);
        result.ks[c] = ks;
        result.misfit += line.color2 - 2 * ks * product + ks * ks * lobe2;
        result.score += weight * std::pow(ks - prior_.ks[c], 2);
        // The integral over ks of a normal distribution is as its width.
        result.score += unit_ * std::log(bend / weight);
        result.told += lobe2 / bend / 3;
    }
    result.score += result.misfit;
    return result;
}

void WardFitSeries::set_estimate() {
    const auto best = std::ranges::min_element(solutions_, {}, &Solution::score);
    double sum = 0, place = 0, place2 = 0, told = 0;
    glm::dvec3 ks(0);
    for (int i = 0; i <= kSteps; ++i) {
        const Solution& at = solutions_[static_cast<size_t>(i)];
        const double likely = std::exp((best->score - at.score) / (2 * unit_));
        sum += likely;
        place += likely * i;
        place2 += likely * i * i;
        ks += likely * at.ks;
        told += likely * at.told;
    }
    estimate_ = {glm::dvec3(0), ks / sum, alpha_of(place / sum)};
    const double octaves_per_step = std::log2(kMost / kLeast) / kSteps;
    const double spread2 = (place2 / sum - std::pow(place / sum, 2)) * octaves_per_step * octaves_per_step;
    confidence_ = told / sum / (max_of(estimate_.ks) < 0.01 ? 1 : 1 + spread2 / (0.3 * 0.3));
    doubt_blue();
    double count = 0;
    for (const Line& line : lines_[static_cast<size_t>(best - solutions_.begin())]) count += line.count;
    deviation_ = std::sqrt(std::max(best->misfit, 0.0) / std::max(count, 1.0));
}

/// Strong gloss that is 1.3 to 1.6 times bluer than red is a window's.
void WardFitSeries::doubt_blue() {
    const auto step = [](double low, double high, double value) {
        const double t = std::clamp((value - low) / (high - low), 0.0, 1.0);
        return t * t * (3 - 2 * t);
    };
    const double doubt =
        step(0.2, 0.3, max_of(estimate_.ks)) * step(1.3, 1.6, estimate_.ks.b / std::max(estimate_.ks.r, 1e-6));
    estimate_.ks += doubt * (prior_.ks - estimate_.ks);
    estimate_.alpha += doubt * (prior_.alpha - estimate_.alpha);
    confidence_ *= 1 - doubt;
}

Ward WardFitSeries::fit(const std::vector<FittedVoxel>& voxels) {
    std::vector<Weighed> weighed;
    for (const FittedVoxel& voxel : voxels) weighed.push_back(weigh(voxel));
    unit_ = prior_.correlated * std::pow(std::max(fits_ == 0 ? 1 : deviation_, 0.1), 2);
    for (size_t step = 0; step < lines_.size(); ++step) {
        const std::array<Line, 3> now = sum(weighed, step);
        const double memory = fits_ == 0 ? 0 : 0.93;
        double near = 0;
        for (const Weighed& each : weighed) near += peak_seen(each.voxel, alpha_of(static_cast<double>(step)));
        seen_[step] = std::max(near, memory * seen_[step]);
        for (size_t c = 0; c < 3; ++c) {
            Line& kept = lines_[step][c];
            kept = {now[c].lobe2 + memory * kept.lobe2, now[c].product + memory * kept.product,
                    now[c].color2 + memory * kept.color2, now[c].count + memory * kept.count};
        }
        solutions_[step] = solve(step);
    }
    set_estimate();
    sum_diffuse(weighed);
    ++fits_;
    return estimate_;
}

void WardFitSeries::sum_diffuse(const std::vector<Weighed>& voxels) {
    const bool often = fits_ + 1 > 4;
    if (often && (fits_ + 1) % 4 != 0) return;
    const double memory = fits_ == 0 ? 0 : std::pow(0.93, often ? 4 : 1);
    diffuse_ *= memory;
    light2_ *= memory;
    for (const auto& [voxel, weights] : voxels) {
        const Ward white{glm::dvec3(1), glm::dvec3(0), 1};
        const glm::dvec3 light = shade(white, voxel.point, voxel.lights, ambient_, voxel.point.normal);
        for (size_t k = 0; k < weights.size(); ++k) {
            const SeenColor& seen = voxel.observations[k];
            const glm::dvec3 rest = seen.rgb - estimate_.ks * lobe_of(voxel, estimate_.alpha, seen);
            for (glm::length_t c = 0; c < 3; ++c) {
                if (seen.clipped[static_cast<size_t>(c)]) continue;
                diffuse_[c] += weights[k] * light[c] * rest[c];
                light2_[c] += weights[k] * light[c] * light[c];
            }
        }
    }
}

glm::dvec3 WardFitSeries::kd() const { return glm::clamp(diffuse_ / glm::max(light2_, glm::dvec3(1e-20)), 0.0, 1.0); }

}  // namespace patina::reference
