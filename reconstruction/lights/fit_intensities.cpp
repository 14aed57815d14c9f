#include "reconstruction/lights/fit_intensities.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace patina {
namespace {

constexpr double kNoise = 0.01;           // of pixel values: residuals are told in these
constexpr double kRelativeNoise = 0.1;    // what one albedo per group, highlights and shadow borders leave
constexpr float kHighlightSpread = 0.2f;  // tangent of the half vector's angle at which a highlight is half explained
constexpr double kLeastLit = 0.02;        // of the mean irradiance; darker samples count the same
constexpr uint32_t kAlbedos = 2;          // of a group at most: tiles, print
constexpr double kApart = 1.5;            // the factor between them, at least
constexpr size_t kFewSamples = 12;        // of a group that has but one
constexpr double kSecondMisfit = 0.25;    // of a sample that needs the rarer albedo, at least: shadows are none
constexpr uint32_t kAssignments = 2;      // of samples to albedos, in a step
constexpr double kLeastShare = 1e-6;      // of the mean irradiance, below which a lamp reaches nothing

float brightness(const gpu::LightSample& sample, LightChannel channel) {
    const glm::vec4 c = sample.diffuse;
    return channel == LightChannel::kMean ? (c.r + c.g + c.b) / 3 : c[static_cast<int>(channel)];
}

/// Samples with the same one are of one group.
std::array<int, 5> group_key(const gpu::LightSample& sample, float cell_m) {
    const glm::ivec3 cell(glm::floor(glm::vec3(sample.point_m) / cell_m));
    const float sum = sample.diffuse.r + sample.diffuse.g + sample.diffuse.b;
    return {cell.x, cell.y, cell.z, static_cast<int>(sample.diffuse.r / sum / kChromaticityStep),
            static_cast<int>(sample.diffuse.g / sum / kChromaticityStep)};
}

/// A symmetric system of few unknowns.
class IntensityEquations {
  public:
    explicit IntensityEquations(size_t unknowns) : n_(unknowns), values_(n_ * n_) {}

    void add(std::span<const double> row, double weight) {
        for (size_t i = 0; i < n_; ++i)
            for (size_t k = 0; k <= i; ++k) values_[i * n_ + k] += weight * row[i] * row[k];
    }

    /// The least |rows x|^2 among the x >= 0 with constraint . x = 1; unknowns whose constraint is 0 are 0.
    std::vector<double> smallest(std::span<const double> constraint) const {
        std::vector<size_t> free;
        for (size_t i = 0; i < n_; ++i)
            if (constraint[i] > 0) free.push_back(i);
        std::vector<double> x(n_);
        while (!free.empty()) {
            const std::vector<double> part = solve(free, constraint);
            double total = 0;
            for (size_t i = 0; i < free.size(); ++i) total += part[i] * constraint[free[i]];
            size_t worst = free.size();
            double least = 0;
            for (size_t i = 0; i < free.size(); ++i) {
                const double share = part[i] * constraint[free[i]] / total;
                if (share < least) worst = i, least = share;
            }
            if (worst == free.size()) {
                for (size_t i = 0; i < free.size(); ++i) x[free[i]] = part[i] / total;
                break;
            }
            free.erase(free.begin() + static_cast<ptrdiff_t>(worst));
        }
        return x;
    }

  private:
    double at(size_t i, size_t k) const { return i >= k ? values_[i * n_ + k] : values_[k * n_ + i]; }

    /// Cholesky's decomposition over the free unknowns, of the matrix with a slightly larger diagonal.
    std::vector<double> solve(const std::vector<size_t>& free, std::span<const double> right) const {
        const size_t m = free.size();
        std::vector<double> lower(m * m), x(m);
        for (size_t i = 0; i < m; ++i) {
            for (size_t k = 0; k <= i; ++k) {
                double sum = at(free[i], free[k]) * (i == k ? 1 + 1e-6 : 1.0) + (i == k ? 1e-12 : 0.0);
                for (size_t j = 0; j < k; ++j) sum -= lower[i * m + j] * lower[k * m + j];
                lower[i * m + k] = i == k ? std::sqrt(std::max(sum, 1e-15)) : sum / lower[k * m + k];
            }
        }
        for (size_t i = 0; i < m; ++i) {
            x[i] = right[free[i]];
            for (size_t k = 0; k < i; ++k) x[i] -= lower[i * m + k] * x[k];
            x[i] /= lower[i * m + i];
        }
        for (size_t i = m; i-- > 0;) {
            for (size_t k = i + 1; k < m; ++k) x[i] -= lower[k * m + i] * x[k];
            x[i] /= lower[i * m + i];
        }
        return x;
    }

    size_t n_;
    std::vector<double> values_;
};

/// Iteratively reweighted least squares for the intensities.
class IntensityFit {
  public:
    IntensityFit(std::span<const gpu::LightSample> samples, std::span<const uint32_t> group, uint32_t groups,
                 std::span<const ReceivedLight> lamps, const ReceivedLight& ambient, size_t count, LightChannel channel)
        : begin_(groups + 1),
          members_(count),
          groups_(kAlbedos * groups),
          part_(count),
          count_(count),
          unknowns_(lamps.size() + 1),
          given_(count * unknowns_, 1.0f),
          lit_(count),
          bright_(count),
          weight_(count, 1.0f),
          mean_(unknowns_) {
        for (size_t i = 0; i < count; ++i) {
            for (size_t l = 0; l < lamps.size(); ++l) given_[i * unknowns_ + l] = lamps[l]->by_sample[i];
            if (ambient) given_[i * unknowns_ + lamps.size()] = ambient->by_sample[i];
            for (size_t l = 0; l < unknowns_; ++l) mean_[l] += given(i, l) / static_cast<double>(count);
            bright_[i] = brightness(samples[i], channel);
        }
        sort_members(group.first(count));
        spread_evenly();
    }

    /// Albedos and residuals under the present intensities, and from these the weights.
    void weigh() {
        for (size_t i = 0; i < count_; ++i) {
            double sum = 0;
            for (size_t l = 0; l < unknowns_; ++l) sum += fitted_.intensities[l] * given(i, l);
            lit_[i] = static_cast<float>(sum);
        }
        fitted_.albedo.assign(groups_, 0);
        fitted_.misfit = 0;
        for (uint32_t g = 0; g + 1 < begin_.size(); ++g) {
            const auto members = std::span(members_).subspan(begin_[g], begin_[g + 1] - begin_[g]);
            split(members, kAlbedos * g);
            weigh_group(members, kAlbedos * g);
        }
    }

    /// The intensities under the present weights.
    void solve() {
        std::vector<double> group_bright(groups_), group_given(groups_ * unknowns_), row(unknowns_);
        for (size_t i = 0; i < count_; ++i) {
            group_bright[part_[i]] += double{weight_[i]} * bright_[i];
            for (size_t l = 0; l < unknowns_; ++l)
                group_given[part_[i] * unknowns_ + l] += double{weight_[i]} * given(i, l);
        }
        IntensityEquations equations(unknowns_);
        for (size_t i = 0; i < count_; ++i) {
            const uint32_t g = part_[i];
            if (!(group_bright[g] > 0)) continue;
            const double share = bright_[i] / group_bright[g], scale = 1 / (kLeastLit + lit_[i]);
            for (size_t l = 0; l < unknowns_; ++l) row[l] = share * group_given[g * unknowns_ + l] - given(i, l);
            equations.add(row, weight_[i] * scale * scale);
        }
        fitted_.intensities = equations.smallest(mean_);
    }

    const FittedIntensities& result() const { return fitted_; }

  private:
    float given(size_t sample, size_t lamp) const { return given_[sample * unknowns_ + lamp]; }

    /// Samples by group, each group's in their order.
    void sort_members(std::span<const uint32_t> group) {
        for (const uint32_t g : group) ++begin_[g + 1];
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
        std::vector<uint32_t> next(begin_.begin(), begin_.end() - 1);
        for (uint32_t i = 0; i < group.size(); ++i) members_[next[group[i]]++] = i;
    }

    /// Gives each sample the albedo that explains it better, the first being the more frequent one, the second 0 where
    /// one will do.
    void split(std::span<const uint32_t> members, uint32_t first) {
        for (const uint32_t i : members) part_[i] = first;
        fitted_.albedo[first] = albedo_of(members, first);
        if (members.size() < kFewSamples) return;
        const auto [low, high] = extremes(members);
        std::array<float, kAlbedos> albedo{low, high};
        for (uint32_t step = 0; step < kAssignments; ++step) {
            for (const uint32_t i : members)
                part_[i] = first + (off(i, albedo[1]) * off(i, albedo[1]) < off(i, albedo[0]) * off(i, albedo[0]));
            for (uint32_t k = 0; k < kAlbedos; ++k) albedo[k] = albedo_of(members, first + k);
        }
        const auto seconds = static_cast<size_t>(
            std::count_if(members.begin(), members.end(), [&](uint32_t i) { return part_[i] != first; }));
        if (!(albedo[0] > 0 && albedo[1] > kApart * albedo[0])) {
            for (const uint32_t i : members) part_[i] = first;
            return;
        }
        if (2 * seconds > members.size()) {
            for (const uint32_t i : members) part_[i] = 2 * first + 1 - part_[i];
            std::swap(albedo[0], albedo[1]);
        }
        for (uint32_t k = 0; k < kAlbedos; ++k) fitted_.albedo[first + k] = albedo[k];
    }

    void weigh_group(std::span<const uint32_t> members, uint32_t first) {
        for (const uint32_t i : members) {
            const double squared = off(i, fitted_.albedo[part_[i]]) * off(i, fitted_.albedo[part_[i]]);
            const double misfit = squared / (1 + squared);
            fitted_.misfit +=
                (part_[i] == first ? misfit : std::max(misfit, kSecondMisfit)) / static_cast<double>(count_);
            weight_[i] = static_cast<float>(1 / ((1 + squared) * (1 + squared)));
        }
    }

    /// By how many standard deviations a sample differs from an albedo's.
    double off(uint32_t i, float albedo) const {
        const double expected = double{albedo} * lit_[i];
        return (bright_[i] - expected) / (2 * kNoise + kRelativeNoise * (bright_[i] + expected));
    }

    /// Of the samples that are of a part, by weighted least squares.
    float albedo_of(std::span<const uint32_t> members, uint32_t part) const {
        double both = 0, squares = 0;
        for (const uint32_t i : members) {
            if (part_[i] != part) continue;
            both += double{weight_[i]} * bright_[i] * lit_[i];
            squares += double{weight_[i]} * lit_[i] * lit_[i];
        }
        return squares > 0 ? static_cast<float>(both / squares) : 0;
    }

    /// Albedos that few samples are darker and few are brighter than.
    std::pair<float, float> extremes(std::span<const uint32_t> members) {
        ratios_.resize(members.size());
        for (size_t k = 0; k < members.size(); ++k)
            ratios_[k] = bright_[members[k]] / (lit_[members[k]] + static_cast<float>(kLeastLit));
        const auto quantile = [&](size_t percent) {
            const auto at = ratios_.begin() + static_cast<ptrdiff_t>(percent * (ratios_.size() - 1) / 100);
            std::nth_element(ratios_.begin(), at, ratios_.end());
            return *at;
        };
        return {quantile(15), quantile(85)};
    }

    /// Every lamp that reaches anything gives the same.
    void spread_evenly() {
        for (double& mean : mean_)
            if (mean < kLeastShare) mean = 0;
        const auto reaching = std::count_if(mean_.begin(), mean_.end(), [](double mean) { return mean > 0; });
        for (const double mean : mean_)
            fitted_.intensities.push_back(mean > 0 ? 1 / (mean * static_cast<double>(reaching)) : 0);
    }

    std::vector<uint32_t> begin_, members_;  // of each group the first of its members, and the end; samples by group
    size_t groups_;                          // all groups' albedos
    std::vector<uint32_t> part_;             // which of these a sample has
    size_t count_, unknowns_;                // the last unknown: ambient light
    std::vector<float> given_, lit_, bright_, weight_, ratios_;
    std::vector<double> mean_;
    FittedIntensities fitted_;
};

}  // namespace

LitSurface::LitSurface(std::span<const gpu::LightSample> drawn, float cell_m) {
    std::map<std::array<int, 5>, uint32_t> groups;
    for (uint32_t place = 0; place < gpu::kLightSamples; ++place) {
        const gpu::LightSample& sample = drawn[place];
        if (sample.point_m.w > 0 && brightness(sample, LightChannel::kMean) >= kDarkestSample) {
            const auto next = static_cast<uint32_t>(groups.size());
            group_.push_back(groups.emplace(group_key(sample, cell_m), next).first->second);
            samples_.push_back(sample);
            places_.push_back(place);
        }
        const gpu::LightSample& highlight = drawn[gpu::kLightSamples + place];
        if (highlight.highlight.w > 0) highlights_.push_back(highlight);
    }
    groups_ = static_cast<uint32_t>(groups.size());
}

ReceivedLight LitSurface::received(std::span<const float> row) const {
    auto light = std::make_shared<ReceivedLightValues>();
    for (const uint32_t place : places_) {
        light->by_sample.push_back(row[place]);
        light->mean += row[place] / static_cast<double>(places_.size());
    }
    return light;
}

size_t LitSurface::samples_before(uint32_t place) const {
    return static_cast<size_t>(std::lower_bound(places_.begin(), places_.end(), place) - places_.begin());
}

FittedIntensities LitSurface::fit(std::span<const ReceivedLight> lamps, uint32_t steps, size_t count,
                                  LightChannel channel, const ReceivedLight& ambient) const {
    if (count == 0) return {std::vector<double>(lamps.size() + 1), 0, std::vector<float>(groups_)};
    IntensityFit fit(samples_, group_, groups_, lamps, ambient, count, channel);
    for (uint32_t step = 0; step < steps; ++step) {
        fit.weigh();
        fit.solve();
    }
    fit.weigh();
    return fit.result();
}

std::vector<float> LitSurface::unexplained(glm::vec3 place_m) const {
    std::vector<float> shares;
    shares.reserve(highlights_.size());
    for (const gpu::LightSample& sample : highlights_) {
        const glm::vec3 normal(sample.normal), to_light = place_m - glm::vec3(sample.point_m);
        float share = 1;
        if (glm::dot(to_light, normal) > 0) {
            const glm::vec3 half = glm::normalize(to_light) + glm::vec3(sample.highlight);
            const float along = glm::dot(half, normal);
            const float tan2 = std::max(glm::dot(half, half) / (along * along) - 1, 0.0f);
            share = tan2 / (tan2 + kHighlightSpread * kHighlightSpread);
        }
        shares.push_back(share);
    }
    return shares;
}

}  // namespace patina
