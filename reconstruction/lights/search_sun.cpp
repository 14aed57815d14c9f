#include "reconstruction/lights/search_sun.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "reconstruction/lights/fit_intensities.h"

namespace patina {
namespace {

constexpr float kLeastKnown = 0.02f;  // irradiance over pi: in darker places brightness tells little
constexpr float kBeside_m = 0.6f, kAlongside = 0.95f, kLevel_m = 0.03f;  // samples of one surface
constexpr float kSameTint = 0.08f;                                       // of chromaticity
constexpr float kDullAlbedo = 0.15f;                                     // darker surfaces show more gloss than albedo
constexpr size_t kLeastAlike = 12;                   // samples of one chromaticity, below which none is bright
constexpr float kPatchRatio = 3;                     // times what samples of a chromaticity mostly reflect, or
constexpr float kOneSurface_m = 1.5f;                // what those of the same surface do so near by
constexpr float kShadedShare = 0.2f;                 // of which so many are darker
constexpr float kClips = 0.95f, kUnclipped = 1.05f;  // from one to the other pixel values are clipped
constexpr size_t kLeastAsked = 12;                   // samples that are not
constexpr size_t kLeastShaded = 5;                   // samples that tell an albedo
constexpr int kColorSteps = 5;                       // after which the sun's colour hardly changes
constexpr float kPalest = 0.6f, kStrongest = 1.5f;   // of the mean of the sun's channels: a low sun's red and blue
constexpr uint32_t kLeastPatch = 24;                 // samples, fewer are highlights and lamps' rims
constexpr float kLeastScore = 0.4f;                  // rooms with sun have 0.48 to 0.66
constexpr size_t kFirstTried = 256;                  // bright samples, with which directions are chosen
constexpr uint32_t kDirections = 2048;               // 4.5 degrees apart
constexpr size_t kFinalists = 64;                    // directions that all samples judge
constexpr size_t kStarts = 6;                        // of these, from which directions are moved
constexpr float kWorthMoving = 0.6f;                 // of the best score: moves gain no more
constexpr float kSameCosine = 0.985f;                // 10 degrees: what is nearer is the same patch
constexpr float kMostRival = 0.88f;                  // of the best score: rooms with sun have 0.83, half a patch 0.92
constexpr float kFirstMove = 0.04f, kLastMove = 0.002f;  // of directions, radians
constexpr int kMovesAround = 8;

/// Samples and how bright they are.
class Patches {
  public:
    Patches(std::span<const gpu::LightSample> samples, std::span<const glm::vec3> known)
        : samples_(samples), known_(known) {
        std::map<Tint, std::vector<uint32_t>> by_tint;
        for (uint32_t i = 0; i < samples.size(); ++i)
            if (tells(samples[i])) by_tint[tint_of(samples[i].diffuse)].push_back(i);
        ratio_.resize(samples.size());
        for (const auto& [tint, members] : by_tint) {
            std::vector<uint32_t> alike;
            for (const Tint& other : tints_around(tint))
                if (const auto found = by_tint.find(other); found != by_tint.end())
                    alike.insert(alike.end(), found->second.begin(), found->second.end());
            if (alike.size() < kLeastAlike) continue;
            const float usual = median(alike, [&](uint32_t i) { return reflectance(i, kMean); });
            for (const uint32_t i : members) {
                ratio_[i] = reflectance(i, kMean) / usual;
                told_.push_back(i);
            }
        }
        compare_with_shade();
        for (const uint32_t i : told_)
            if (is_bright(i)) bright_.push_back(i);
    }

    const std::vector<uint32_t>& bright() const { return bright_; }

    /// The harmonic mean of precision and recall.
    static float score(const SunInPatches& sun) {
        const float sum = sun.precision + sun.recall;
        return sum > 0 ? 2 * sun.precision * sun.recall / sum : 0;
    }

    SunInPatches judged(glm::vec3 direction, std::span<const float> cosines) const {
        uint32_t lit = 0, hits = 0;
        for (const uint32_t i : told_) {
            lit += cosines[i] > 0;
            hits += cosines[i] > 0 && is_bright(i);
        }
        SunInPatches sun{.direction = direction, .samples = hits};
        if (lit > 0) sun.precision = static_cast<float>(hits) / static_cast<float>(lit);
        if (!bright_.empty()) sun.recall = static_cast<float>(hits) / static_cast<float>(bright_.size());
        return sun;
    }

    /// What a surface that faces the sun receives, by channel: the median of what bright samples that it lights ask
    /// for beside the known light. The albedo is that of samples beside them, on the same surface and of the same tint,
    /// that it does not reach; tints are told again under each estimate, as the sun has another colour than the room's
    /// light. A channel that is clipped nearly everywhere is as strong as the others, and at least as its values say.
    /// Empty where there are no such borders.
    std::optional<glm::dvec3> strength(std::span<const float> cosines) const {
        const std::vector<Border> borders = borders_of(cosines);
        glm::vec3 sun(0);
        for (int step = 0; step < kColorSteps; ++step) {
            sun = asked_of(step > 0 ? alike(borders, sun, cosines) : borders, cosines);
            const float usual = mean(sun);
            if (!(usual > 0)) return std::nullopt;
            sun = step > 0 ? glm::clamp(sun, kPalest * usual, kStrongest * usual) : glm::vec3(usual);
        }
        return glm::dvec3(sun);
    }

  private:
    static constexpr int kMean = 3;  // of the channels

    bool is_bright(uint32_t i) const { return ratio_[i] > kPatchRatio; }

    /// Where the sun lights most of what has a chromaticity, the usual is in it, too: there the darker part of the same
    /// surface is what a sample is compared with.
    void compare_with_shade() {
        std::vector<Tint> tints;
        for (const uint32_t i : told_) tints.push_back(tint_of(samples_[i].diffuse));
        std::vector<float> same;
        for (size_t a = 0; a < told_.size(); ++a) {
            same.clear();
            for (size_t b = 0; b < told_.size(); ++b)
                if (is_near(tints[a], tints[b]) && is_beside(samples_[told_[a]], samples_[told_[b]], kOneSurface_m))
                    same.push_back(reflectance(told_[b], kMean));
            if (same.size() < kLeastAlike) continue;
            const auto shaded = same.begin() + static_cast<ptrdiff_t>(kShadedShare * static_cast<float>(same.size()));
            std::nth_element(same.begin(), shaded, same.end());
            float& ratio = ratio_[told_[a]];
            if (*shaded > 0) ratio = std::max(ratio, reflectance(told_[a], kMean) / *shaded);
        }
    }

    static float mean(const auto& rgb) { return (rgb.r + rgb.g + rgb.b) / 3; }

    static bool tells(const gpu::LightSample& sample) {
        return sample.point_m.w > 0 && sample.around.w >= 0 && mean(sample.diffuse) >= kDarkestSample;
    }

    using Tint = std::array<int, 2>;

    static Tint tint_of(const auto& rgb) {
        const float sum = 3 * mean(rgb);
        return {static_cast<int>(rgb.r / sum / kChromaticityStep), static_cast<int>(rgb.g / sum / kChromaticityStep)};
    }

    static bool is_near(const Tint& a, const Tint& b) {
        return std::abs(a[0] - b[0]) <= 1 && std::abs(a[1] - b[1]) <= 1;
    }

    /// With what is beside it, as one surface has several under light of several colours.
    static std::array<Tint, 9> tints_around(const Tint& tint) {
        std::array<Tint, 9> all;
        for (int i = 0; i < 9; ++i) all[static_cast<size_t>(i)] = {tint[0] + i % 3 - 1, tint[1] + i / 3 - 1};
        return all;
    }

    static float of_channel(const auto& rgb, int channel) { return channel == kMean ? mean(rgb) : rgb[channel]; }

    /// Of what is known to arrive.
    float reflectance(uint32_t i, int channel) const {
        return of_channel(samples_[i].diffuse, channel) / std::max(kLeastKnown, of_channel(known_[i], channel));
    }

    static float middle(std::vector<float>& values) {
        if (values.empty()) return 0;
        const auto at = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), at, values.end());
        return *at;
    }

    /// A bright sample, and those beside it on the same surface that are not, and that the sun does not reach.
    struct Border {
        uint32_t lit = 0;
        std::vector<uint32_t> shaded;
    };

    std::vector<Border> borders_of(std::span<const float> cosines) const {
        std::vector<Border> borders;
        for (const uint32_t i : bright_) {
            if (cosines[i] <= 0) continue;
            Border border{i, {}};
            for (const uint32_t k : told_)
                if (cosines[k] <= 0 && !is_bright(k) && is_beside(samples_[i], samples_[k], kBeside_m))
                    border.shaded.push_back(k);
            if (border.shaded.size() >= kLeastShaded) borders.push_back(std::move(border));
        }
        return borders;
    }

    static bool is_beside(const gpu::LightSample& a, const gpu::LightSample& b, float within_m) {
        const glm::vec3 apart_m(a.point_m - b.point_m), normal(a.normal);
        return glm::dot(apart_m, apart_m) < within_m * within_m && glm::dot(normal, glm::vec3(b.normal)) > kAlongside &&
               std::abs(glm::dot(apart_m, normal)) < kLevel_m;
    }

    /// Those whose shaded samples have about the tint that the lit one has under a sun.
    std::vector<Border> alike(const std::vector<Border>& borders, glm::vec3 sun, std::span<const float> cosines) const {
        std::vector<Border> same;
        for (const Border& border : borders) {
            const glm::vec3 tint = tint_under(border.lit, cosines[border.lit] * sun);
            Border with{border.lit, {}};
            for (const uint32_t k : border.shaded)
                if (glm::distance(tint_under(k, glm::vec3(0)), tint) < kSameTint) with.shaded.push_back(k);
            if (with.shaded.size() >= kLeastShaded) same.push_back(std::move(with));
        }
        return same;
    }

    /// Of the albedo; its channels add up to 1.
    glm::vec3 tint_under(uint32_t i, glm::vec3 sun) const {
        const glm::vec3 albedo = glm::vec3(samples_[i].diffuse) / glm::max(known_[i] + sun, kLeastKnown);
        return albedo / (3 * mean(albedo));
    }

    /// What samples ask for, and how much each counts: their albedo, as dark ones show gloss.
    struct Asked {
        std::vector<std::pair<float, float>> told, at_least;
    };

    Asked asked_in(std::span<const Border> borders, int channel, std::span<const float> cosines,
                   float least_albedo) const {
        Asked asked;
        for (const Border& border : borders) {
            const float albedo = median(border.shaded, [&](uint32_t i) { return reflectance(i, channel); });
            const float usual = median(border.shaded, [&](uint32_t i) { return reflectance(i, kMean); });
            if (!(albedo > 0) || usual < least_albedo) continue;
            const uint32_t i = border.lit;
            const float value = samples_[i].diffuse[channel];
            auto& values = value > kClips && value < kUnclipped ? asked.at_least : asked.told;
            values.emplace_back((value / albedo - known_[i][channel]) / cosines[i], usual);
        }
        return asked;
    }

    /// By channel; 0 where nothing is lit.
    glm::vec3 asked_of(std::span<const Border> borders, std::span<const float> cosines) const {
        for (const float least_albedo : {kDullAlbedo, 0.0f}) {
            glm::vec3 sun(0), at_least(0);
            int told = 0;
            for (int c = 0; c < 3; ++c) {
                Asked asked = asked_in(borders, c, cosines, least_albedo);
                at_least[c] = weighted_median(asked.at_least);
                if (asked.told.size() < kLeastAsked) continue;
                sun[c] = std::max(weighted_median(asked.told), 0.0f);
                ++told;
            }
            if (told == 0 && least_albedo > 0) continue;
            if (told == 0) return at_least;
            const float others = (sun.r + sun.g + sun.b) / static_cast<float>(told);
            for (int c = 0; c < 3; ++c)
                if (sun[c] == 0) sun[c] = std::max(others, at_least[c]);
            return sun;
        }
        return glm::vec3(0);
    }

    static float weighted_median(std::vector<std::pair<float, float>>& values) {
        std::ranges::sort(values);
        float rest = 0;
        for (const auto& [value, weight] : values) rest += 0.5f * weight;
        for (const auto& [value, weight] : values)
            if ((rest -= weight) <= 0) return value;
        return 0;
    }

    static float median(std::span<const uint32_t> members, const auto& value) {
        std::vector<float> values;
        for (const uint32_t i : members) values.push_back(value(i));
        return middle(values);
    }

    std::span<const gpu::LightSample> samples_;
    std::span<const glm::vec3> known_;
    std::vector<uint32_t> told_;  // samples of which it is known whether they are bright
    std::vector<float> ratio_;    // of what is reflected to the usual, by sample; 0: tells nothing
    std::vector<uint32_t> bright_;
};

/// Evenly, on a spiral from pole to pole.
std::vector<glm::vec3> directions_all_around() {
    const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
    std::vector<glm::vec3> all;
    for (uint32_t i = 0; i < kDirections; ++i) {
        const double z = 1 - (2 * i + 1.0) / kDirections, radius = std::sqrt(1 - z * z), angle = golden_angle * i;
        all.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
    return all;
}

std::vector<glm::vec3> directions_around(glm::vec3 middle, float angle) {
    const glm::vec3 across = std::abs(middle.z) < 0.9f ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0);
    const glm::vec3 u = glm::normalize(glm::cross(middle, across)), v = glm::cross(middle, u);
    std::vector<glm::vec3> around;
    for (int i = 0; i < kMovesAround; ++i) {
        const float turn = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kMovesAround;
        around.push_back(glm::normalize(middle + angle * (std::cos(turn) * u + std::sin(turn) * v)));
    }
    return around;
}

class SunSearch {
  public:
    SunSearch(std::span<const gpu::LightSample> samples, const Patches& patches, const TrySuns& try_suns)
        : samples_(samples), patches_(patches), try_(try_suns) {}

    /// Empty where a direction far from the best one is nearly as good.
    std::optional<SunInPatches> run() {
        std::vector<SunInPatches> tops;
        for (const SunInPatches& start : starts()) {
            if (!tops.empty() && Patches::score(start) < kWorthMoving * Patches::score(tops.front())) break;
            take(start);
            for (float angle = kFirstMove; angle > kLastMove;)
                if (!try_all(directions_around(best_.direction, angle))) angle *= 0.5f;
            tops.push_back(best_);
        }
        if (tops.empty()) return std::nullopt;
        const auto best = std::ranges::max_element(tops, {}, Patches::score);
        for (const SunInPatches& other : tops) {
            const bool apart = glm::dot(other.direction, best->direction) < kSameCosine;
            if (apart && Patches::score(other) > kMostRival * Patches::score(*best)) return std::nullopt;
        }
        take(*best);
        return best_;
    }

    std::span<const float> cosines() const { return cosines_; }

  private:
    /// The best of the finalists that are well apart.
    std::vector<SunInPatches> starts() {
        std::vector<SunInPatches> judged;
        const std::vector<glm::vec3> directions = finalists();
        if (directions.empty()) return {};
        const std::vector<float> tried = try_(samples_, directions);
        for (size_t d = 0; d < directions.size(); ++d)
            judged.push_back(patches_.judged(directions[d], row_of(tried, d)));
        std::ranges::stable_sort(judged, std::greater(), Patches::score);
        std::vector<SunInPatches> apart;
        for (const SunInPatches& next : judged) {
            if (apart.size() == kStarts) break;
            if (std::ranges::none_of(apart, [&](const SunInPatches& other) {
                    return glm::dot(other.direction, next.direction) > kSameCosine;
                }))
                apart.push_back(next);
        }
        return apart;
    }

    std::span<const float> row_of(const std::vector<float>& tried, size_t direction) const {
        return std::span(tried).subspan(direction * samples_.size(), samples_.size());
    }

    void take(const SunInPatches& sun) {
        best_ = sun;
        cosines_ = try_(samples_, std::span(&sun.direction, 1));
    }

    /// Those that light the most of the bright samples.
    std::vector<glm::vec3> finalists() const {
        std::vector<gpu::LightSample> bright;
        const size_t count = patches_.bright().size(), step = (count + kFirstTried - 1) / kFirstTried;
        for (size_t i = 0; i < count; i += step) bright.push_back(samples_[patches_.bright()[i]]);
        std::vector<std::pair<size_t, glm::vec3>> ranked;
        const std::vector<glm::vec3> all = directions_all_around();
        const std::vector<float> tried = try_(bright, all);
        for (size_t d = 0; d < all.size(); ++d) {
            const auto row = std::span(tried).subspan(d * bright.size(), bright.size());
            const auto lit = std::count_if(row.begin(), row.end(), [](float cosine) { return cosine > 0; });
            ranked.emplace_back(static_cast<size_t>(lit), all[d]);
        }
        std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
        std::vector<glm::vec3> best;
        for (size_t i = 0; i < std::min(kFinalists, ranked.size()) && ranked[i].first > 0; ++i)
            best.push_back(ranked[i].second);
        return best;
    }

    /// Whether one of them is better than the best so far, which it becomes.
    bool try_all(std::span<const glm::vec3> directions) {
        const std::vector<float> tried = try_(samples_, directions);
        bool better = false;
        for (size_t d = 0; d < directions.size(); ++d) {
            const std::span<const float> row = row_of(tried, d);
            const SunInPatches sun = patches_.judged(directions[d], row);
            if (Patches::score(sun) <= Patches::score(best_)) continue;
            best_ = sun;
            cosines_.assign(row.begin(), row.end());
            better = true;
        }
        return better;
    }

    std::span<const gpu::LightSample> samples_;
    const Patches& patches_;
    const TrySuns& try_;
    SunInPatches best_;
    std::vector<float> cosines_;  // of the best, by sample
};

}  // namespace

std::optional<SunInPatches> search_sun(std::span<const gpu::LightSample> samples, std::span<const glm::vec3> known,
                                       const TrySuns& try_suns) {
    const Patches patches(samples, known);
    if (patches.bright().size() < kLeastPatch) return std::nullopt;
    SunSearch search(samples, patches, try_suns);
    std::optional<SunInPatches> found = search.run();
    if (!found) return std::nullopt;
    SunInPatches& sun = *found;
    if (sun.samples < kLeastPatch || Patches::score(sun) < kLeastScore) return std::nullopt;
    const auto strength = patches.strength(search.cosines());
    if (!strength) return std::nullopt;
    sun.irradiance = *strength;
    return found;
}

std::optional<glm::dvec3> sun_strength(std::span<const gpu::LightSample> samples, std::span<const glm::vec3> known,
                                       std::span<const float> cosines) {
    return Patches(samples, known).strength(cosines);
}

}  // namespace patina
