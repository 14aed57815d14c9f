#include "reconstruction/lights/search_lights.h"

#include <algorithm>
#include <cmath>

namespace patina {
namespace {

constexpr uint32_t kCoarsePlaces = 1024;  // of the samples, from which new lamps are judged
constexpr uint32_t kCoarseSteps = 3, kFineSteps = 4;
constexpr double kMostPlaces = 1500;                                              // that a new lamp may have
constexpr float kMarginShare = 0.35f, kLeastMarginM = 0.5f, kMostMarginM = 2.5f;  // around what was seen
constexpr float kFirstMoveM = 0.3f, kLastMoveM = 0.03f, kShorter = 0.6f;
constexpr double kFewHighlights = 200;  // they count half
constexpr double kLeastLight = 0.01;    // of the mean irradiance
constexpr double kLeastCost = 0.05;     // what the best explanation leaves: lamps that gain little beside it are none
constexpr double kWorthwhile = 0.998;   // of the cost before: moves stay as long as they are
constexpr float kSamePlace = 0.35f;     // of a lamp's distance from the middle of the surface

/// Along axes and diagonals.
std::vector<glm::vec3> directions() {
    std::vector<glm::vec3> all;
    for (const glm::vec3& axis : {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1)}) {
        all.push_back(axis);
        all.push_back(-axis);
    }
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 d((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1);
        all.push_back(d / std::sqrt(3.0f));
    }
    return all;
}

/// A lattice around all samples, then what was seen.
std::vector<glm::vec3> places_around(const LitSurface& surface, std::span<const glm::vec3> seen_m) {
    glm::vec3 low(1e9f), high(-1e9f);
    for (const gpu::LightSample& sample : surface.samples()) {
        low = glm::min(low, glm::vec3(sample.point_m));
        high = glm::max(high, glm::vec3(sample.point_m));
    }
    const float margin_m = std::clamp(kMarginShare * glm::distance(low, high), kLeastMarginM, kMostMarginM);
    low -= margin_m;
    const glm::vec3 size = high + margin_m - low;
    const double volume = double{size.x} * size.y * size.z;
    const auto spacing_m = static_cast<float>(std::max(std::cbrt(volume / kMostPlaces), 0.2));
    std::vector<glm::vec3> places;
    for (float z = spacing_m / 2; z < size.z; z += spacing_m)
        for (float y = spacing_m / 2; y < size.y; y += spacing_m)
            for (float x = spacing_m / 2; x < size.x; x += spacing_m) places.push_back(low + glm::vec3(x, y, z));
    places.insert(places.end(), seen_m.begin(), seen_m.end());
    return places;
}

class Search {
  public:
    Search(const LitSurface& surface, const TryLamps& try_lamps, std::span<const glm::vec3> seen_m,
           const LightSearchSettings& settings, const GivenLight& given)
        : surface_(surface), try_(try_lamps), seen_m_(seen_m), settings_(settings), given_(given) {}

    std::vector<TrialLamp> run() {
        const std::vector<TrialLamp> places = try_(places_around(surface_, seen_m_), kCoarsePlaces);
        double best = cost(lamps_);
        while (lamps_.size() < settings_.most_lamps) {
            const std::vector<TrialLamp> before = lamps_;
            lamps_.push_back(best_addition(places));
            const double now = move_all();
            // Two more lamps may help where neither does alone: what a lamp must be worth in the end is asked later.
            if (now > (1 - 0.5 * std::min(settings_.least_gain, settings_.expected_gain)) * best) {
                lamps_ = before;
                break;
            }
            best = now;
        }
        while (remove_one()) move_all();
        return lamps_;
    }

  private:
    double cost(std::span<const TrialLamp> lamps) const { return cost(lamps, kFineSteps, surface_.size()); }
    double cost(std::span<const TrialLamp> lamps, uint32_t steps, size_t count) const {
        std::vector<ReceivedLight> received;
        for (const TrialLamp& lamp : lamps) received.push_back(lamp.received);
        received.insert(received.end(), given_.lights.begin(), given_.lights.end());
        const FittedIntensities fitted = surface_.fit(received, steps, count, LightChannel::kMean, given_.ambient);
        const auto highlights = static_cast<double>(surface_.highlights().size());
        const double share = settings_.highlight_share * highlights / (highlights + kFewHighlights);
        return kLeastCost + fitted.misfit + share * unexplained_highlights(surface_, lamps, fitted.intensities);
    }

    TrialLamp best_addition(const std::vector<TrialLamp>& places) const {
        const size_t count = surface_.samples_before(kCoarsePlaces);
        std::vector<TrialLamp> trial = lamps_;
        trial.emplace_back();
        const TrialLamp* best = &places.front();
        double least = 1e9;
        for (const TrialLamp& place : places) {
            trial.back() = place;
            const double value = cost(trial, kCoarseSteps, count);
            if (value < least) best = &place, least = value;
        }
        return try_(std::span(&best->place_m, 1), gpu::kLightSamples).front();
    }

    /// Moves each lamp in turn to the best of the places around it, by ever shorter moves. Returns the cost.
    double move_all() {
        const std::vector<glm::vec3> around = directions();
        double now = cost(lamps_);
        for (float move_m = kFirstMoveM; move_m > kLastMoveM;) {
            std::vector<glm::vec3> places_m;
            for (const TrialLamp& lamp : lamps_)
                for (const glm::vec3& direction : around) places_m.push_back(lamp.place_m + move_m * direction);
            const std::vector<TrialLamp> tried = try_(places_m, gpu::kLightSamples);
            const double before = now;
            for (size_t l = 0; l < lamps_.size(); ++l) {
                std::vector<TrialLamp> trial = lamps_;
                for (size_t d = 0; d < around.size(); ++d) {
                    trial[l] = tried[l * around.size() + d];
                    const double value = cost(trial);
                    if (value < now) lamps_[l] = trial[l], now = value;
                }
            }
            if (now > kWorthwhile * before) move_m *= kShorter;
        }
        return now;
    }

    /// By how much the cost without a lamp exceeds what makes it worth having; `now` is the cost with it.
    double worth(size_t lamp, double now) const {
        std::vector<TrialLamp> without = lamps_;
        without.erase(without.begin() + static_cast<ptrdiff_t>(lamp));
        const bool expected =
            std::ranges::any_of(seen_m_, [&](glm::vec3 m) { return is_same_place(surface_, lamps_[lamp].place_m, m); });
        return (1 - double{expected ? settings_.expected_gain : settings_.least_gain}) * cost(without) - now;
    }

    /// Leaves out the lamp that matters least, if it matters too little.
    bool remove_one() {
        const double now = cost(lamps_);
        std::vector<double> worths;
        for (size_t l = 0; l < lamps_.size(); ++l) worths.push_back(worth(l, now));
        const auto least = std::ranges::min_element(worths);
        if (least == worths.end() || *least > 0) return false;
        lamps_.erase(lamps_.begin() + (least - worths.begin()));
        return true;
    }

    const LitSurface& surface_;
    const TryLamps& try_;
    std::span<const glm::vec3> seen_m_;
    LightSearchSettings settings_;
    const GivenLight& given_;
    std::vector<TrialLamp> lamps_;
};

}  // namespace

bool is_same_place(const LitSurface& surface, glm::vec3 a_m, glm::vec3 b_m) {
    glm::vec3 middle_m(0);
    for (const gpu::LightSample& sample : surface.samples())
        middle_m += glm::vec3(sample.point_m) / static_cast<float>(surface.size());
    return glm::distance(a_m, b_m) < kSamePlace * glm::distance(a_m, middle_m);
}

double unexplained_highlights(const LitSurface& surface, std::span<const TrialLamp> lamps,
                              std::span<const double> intensities) {
    std::vector<const TrialLamp*> shining;
    for (size_t l = 0; l < lamps.size(); ++l)
        if (intensities[l] * lamps[l].received->mean > kLeastLight) shining.push_back(&lamps[l]);
    double sum = 0, total = 0;
    for (size_t i = 0; i < surface.highlights().size(); ++i) {
        float least = 1;
        for (const TrialLamp* lamp : shining) least = std::min(least, lamp->unexplained[i]);
        const double strength = surface.highlights()[i].highlight.w;
        sum += strength * least;
        total += strength;
    }
    return total > 0 ? sum / total : 0;
}

std::vector<TrialLamp> search_lights(const LitSurface& surface, const TryLamps& try_lamps,
                                     std::span<const glm::vec3> seen_m, const LightSearchSettings& settings,
                                     const GivenLight& given) {
    if (surface.size() == 0) return {};
    return Search(surface, try_lamps, seen_m, settings, given).run();
}

}  // namespace patina
