#include "tests/reference/specular/bound_materials.h"

#include <algorithm>
#include <cmath>

namespace patina::reference {

namespace {

// Deviations of log2(alpha), of log(ks + 0.003) and of log(kd + 0.0005).
constexpr double kKsOffset = 0.003, kKdOffset = 0.0005;
constexpr double kUnseen = 0.47;
constexpr double kOfDoubt = 0.15;
constexpr double kBlur = 0.048;

/// Student's distribution with two degrees of freedom; another deviation on either side of the middle.
struct Spread {
    double weight, middle, less, more;

    double below(double x) const {
        const double t = (x - middle) / (x < middle ? less : more);
        return weight * (1 + t / std::sqrt(2 + t * t)) / 2;
    }
};

/// The sum of distributions whose weights sum to 1, as a table.
class Distribution {
  public:
    Distribution(const std::vector<Spread>& parts, double least, double most) : least_(least), most_(most) {
        for (int i = 0; i <= kSteps; ++i) {
            below_.push_back(0);
            for (const Spread& part : parts) below_.back() += part.below(at(i));
        }
    }

    /// Where it has the share `p` below it.
    double quantile(double p) const {
        if (p <= below_.front()) return least_;
        for (size_t i = 1; i < below_.size(); ++i) {
            if (below_[i] < p) continue;
            const double part = (p - below_[i - 1]) / (below_[i] - below_[i - 1]);
            return at(static_cast<double>(i) - 1 + part);
        }
        return most_;
    }

  private:
    static constexpr int kSteps = 8000;
    double at(double step) const { return least_ + (most_ - least_) * step / kSteps; }

    double least_, most_;
    std::vector<double> below_;
};

double squared(double x) { return x * x; }

/// The t whose interval -t to t has a probability.
double student(double probability) { return probability * std::sqrt(2 / (1 - squared(probability))); }

double doubt_of(const BoundedSegment& segment) {
    if (!segment.kd || !segment.squares_kd) return 1;
    double sum = 0;
    for (int c = 0; c < 3; ++c)
        sum += std::abs(std::log(((*segment.kd)[c] + 0.01) / (std::clamp((*segment.squares_kd)[c], 0.0, 1.0) + 0.01)));
    return sum / 3;
}

/// One alpha's part: with the ks that its sums show, and with one that nobody saw.
struct Part {
    double fitted = 0, unseen = 0;  ///< logarithms of weights, not normalised
    glm::dvec3 ks{0}, noise{0};
};

Part part_of(const AlphaSums& sums, double deviation) {
    Part part;
    const double unit = 50 * squared(std::max(deviation, 0.1)), stiff = unit / squared(0.15);
    double evidence = 0;
    for (int c = 0; c < 3; ++c) {
        const double bend = sums.lobe2[c] + stiff;
        const double ks = std::max((sums.product[c] + 0.04 * stiff) / bend, 0.0);
        // What the squared errors are less than without a highlight; the prior; the width of what ks may be.
        evidence += (2 * ks * sums.product[c] - ks * ks * sums.lobe2[c]) / unit;
        evidence -= squared((ks - 0.04) / 0.15) + std::log(bend / stiff);
        part.ks[c] = ks;
        part.noise[c] = std::min(std::sqrt(unit / bend) / (ks + kKsOffset), kUnseen);
    }
    const double prior = -squared(std::log2(sums.alpha / 0.4) / 2) / 2;
    const double seen = 0.83 * std::min(sums.seen / 2.3, 1.0);
    part.fitted = prior + std::log(seen) + evidence / 2;
    part.unseen = prior + std::log(1 - seen);
    return part;
}

}  // namespace

BoundedMaterial bound_material(const BoundedSegment& segment, double probability) {
    const double doubt = doubt_of(segment);
    std::vector<Part> parts;
    double most_likely = -1e300, sum = 0;
    for (const AlphaSums& each : segment.sums) {
        parts.push_back(part_of(each, segment.deviation));
        most_likely = std::max({most_likely, parts.back().fitted, parts.back().unseen});
    }
    for (Part& part : parts) {
        part.fitted = std::exp(part.fitted - most_likely);
        part.unseen = std::exp(part.unseen - most_likely);
        sum += part.fitted + part.unseen;
    }
    std::array<std::vector<Spread>, 4> spreads;  // of ks by channel, and of alpha
    for (size_t i = 0; i < parts.size(); ++i) {
        const Part& part = parts[i];
        const double alpha = segment.sums[i].alpha, blur = squared(kBlur / alpha);
        const double common = std::hypot(0.04, kOfDoubt * doubt);
        spreads[3].push_back({(part.fitted + part.unseen) / sum, std::log2(alpha), std::hypot(common, blur), common});
        for (int c = 0; c < 3; ++c) {
            const double noise = std::hypot(part.noise[c], kOfDoubt * doubt);
            auto& of_ks = spreads[static_cast<size_t>(c)];
            of_ks.push_back({part.fitted / sum, std::log(part.ks[c] + kKsOffset), std::hypot(0.02, noise),
                             std::hypot(0.035, noise, 0.6 * blur)});
            of_ks.push_back({part.unseen / sum, std::log(0.04 + kKsOffset), 1.0, kUnseen});
        }
    }
    std::vector<Distribution> distributions;
    for (size_t i = 0; i < 3; ++i) distributions.emplace_back(spreads[i], std::log(kKsOffset), std::log(1 + kKsOffset));
    distributions.emplace_back(spreads[3], std::log2(0.01), 0.0);
    const auto ends_of = [&](size_t parameter, double p) -> std::array<double, 2> {
        const auto end = [&](double share) {
            const double x = distributions[parameter].quantile(share);
            return parameter == 3 ? std::exp2(x) : std::max(std::exp(x) - kKsOffset, 0.0);
        };
        const double estimate = parameter == 3 ? segment.alpha : segment.ks[static_cast<glm::length_t>(parameter)];
        return {std::min(end((1 - p) / 2), estimate), std::max(end((1 + p) / 2), estimate)};
    };

    BoundedMaterial result;
    for (size_t i = 0; i < 4; ++i) {
        const auto [low, high] = ends_of(i, probability);
        result.low[i] = low;
        result.high[i] = high;
    }
    double ks_spread2 = 0, most_ks = 0;
    for (size_t c = 0; c < 3; ++c) {
        const auto [low, high] = ends_of(c, 0.9);
        ks_spread2 += squared(std::log((high + kKsOffset) / (low + kKsOffset)) / (2 * student(0.9)) / 0.4) / 3;
        most_ks = std::max(most_ks, high);
        const auto [low80, high80] = ends_of(c, 0.8);
        result.low[4 + c] = 0;
        result.high[4 + c] = 1;
        if (!segment.kd) continue;
        const double kd = (*segment.kd)[static_cast<glm::length_t>(c)];
        const double of_ks = 0.15 * segment.alpha * (high80 - low80) / (2 * student(0.8));
        const double deviation = std::hypot(std::hypot(of_ks, 0.01 * kd) / (kd + kKdOffset), 1.5 * doubt);
        const double factor = std::exp(student(probability) * deviation);
        result.low[4 + c] = std::max((kd + kKdOffset) / factor - kKdOffset, 0.0);
        result.high[4 + c] = std::min((kd + kKdOffset) * factor - kKdOffset, 1.0);
    }
    const auto [least_alpha, most_alpha] = ends_of(3, 0.9);
    const double alpha_spread = std::log2(most_alpha / least_alpha) / (2 * student(0.9)) / 0.4;
    result.confidence = 1 / ((1 + ks_spread2) * (most_ks < 0.02 ? 1 : 1 + squared(alpha_spread)));
    result.confidence = std::min(result.confidence, segment.fit_confidence);
    return result;
}

}  // namespace patina::reference
