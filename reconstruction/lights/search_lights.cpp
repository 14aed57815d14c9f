#include "reconstruction/lights/search_lights.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <future>
#include <thread>
#include <utility>

#include "patina/lighting.h"

namespace patina {
namespace {

constexpr uint32_t kCoarsePlaces = 1024;  // of the samples, from which new lamps are judged
constexpr uint32_t kCoarseSteps = 3, kFineSteps = 4;
constexpr double kMostPlaces = 1500;                                              // that a new lamp may have
constexpr float kMarginShare = 0.35f, kLeastMarginM = 0.5f, kMostMarginM = 2.5f;  // around what was seen
constexpr float kTurnByMove = 1.5f;  // radians of a lamp's axis by metres of its place: 0.45 at first, 0.05 at last
constexpr float kFirstMoveM = 0.3f, kLastMoveM = 0.03f, kShorter = 0.6f;
constexpr double kFewHighlights = 200;  // they count half
constexpr double kLeastLight = 0.01;    // of the mean irradiance
constexpr double kLeastCost = 0.05;     // what the best explanation leaves: lamps that gain little beside it are none
constexpr double kNoLamp = 1e9;         // a cost
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

/// value(0), value(1) ...; each may be computed beside the others.
std::vector<double> in_parallel(size_t count, const std::function<double(size_t)>& value) {
    std::vector<double> values(count);
    const size_t workers = std::clamp<size_t>(std::thread::hardware_concurrency(), 1, std::max<size_t>(count, 1));
    const auto work = [&](size_t first) {
        for (size_t i = first; i < count; i += workers) values[i] = value(i);
    };
    std::vector<std::future<void>> others;
    for (size_t w = 1; w < workers; ++w) others.push_back(std::async(std::launch::async, work, w));
    work(0);
    for (std::future<void>& other : others) other.get();
    return values;
}

bool is_flat(const TrialLamp& lamp) { return lamp.axis != glm::vec3(0); }

glm::vec3 middle_of(const LitSurface& surface) {
    glm::vec3 middle_m(0);
    for (const gpu::LightSample& sample : surface.samples())
        middle_m += glm::vec3(sample.point_m) / static_cast<float>(surface.size());
    return middle_m;
}

class Search {
  public:
    Search(const LitSurface& surface, const TryLamps& try_lamps, std::span<const glm::vec3> seen_m,
           const LightSearchSettings& settings, const GivenLight& given)
        : surface_(surface),
          try_(try_lamps),
          seen_m_(seen_m),
          settings_(settings),
          given_(given),
          lamps_(given.lamps) {}

    std::vector<TrialLamp> run() {
        const std::vector<TrialLamp> places = try_(places_around(surface_, seen_m_), kCoarsePlaces);
        double least = move_all();
        std::vector<std::vector<TrialLamp>> best{lamps_};  // of each number of lamps
        const double least_gain = std::min(settings_.least_gain, settings_.expected_gain);
        while (added() < settings_.most_lamps) {
            const double now = add_one(places);
            // Two more lamps may help where neither does alone: what a lamp must be worth in the end is asked later.
            if (now > (1 - 0.5 * least_gain) * least) break;
            best.push_back(lamps_);
            least = now;
        }
        while (best.size() > 1 && cost(best.back()) > (1 - least_gain) * cost(best.end()[-2])) best.pop_back();
        lamps_ = best.back();
        while (remove_one()) {
            const double moved = move_all();
            if (handicapped(best[added()]) < moved) lamps_ = best[added()];
        }
        return lamps_;
    }

  private:
    size_t added() const { return lamps_.size() - given_.lamps.size(); }

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

    /// The cost, and what flat lamps must be worth more than others.
    double handicapped(std::span<const TrialLamp> lamps) const {
        return handicapped(lamps, kFineSteps, surface_.size());
    }
    double handicapped(std::span<const TrialLamp> lamps, uint32_t steps, size_t count) const {
        const auto flat = std::ranges::count_if(lamps, [](const TrialLamp& lamp) { return is_flat(lamp); });
        return cost(lamps, steps, count) / std::pow(1 - double{settings_.flat_gain}, static_cast<double>(flat));
    }

    /// Adds the lamp that helps most once all are moved, begun as one that shines all around and as a flat one: each
    /// may stay near a place where the other would be better. Returns the cost.
    double add_one(const std::vector<TrialLamp>& places) {
        const std::vector<TrialLamp> before = lamps_;
        lamps_.push_back(best_addition(places, false));
        const double all_around = move_all();
        std::vector<TrialLamp> first = std::exchange(lamps_, before);
        lamps_.push_back(best_addition(places, true));
        const double flat = move_all();
        if (flat < all_around) return flat;
        lamps_ = std::move(first);
        return all_around;
    }

    /// `flat`: among flat lamps that face the middle of the surface, else among those that shine all around.
    TrialLamp best_addition(const std::vector<TrialLamp>& places, bool flat) const {
        const size_t count = surface_.samples_before(kCoarsePlaces);
        const glm::vec3 middle_m = middle_of(surface_);
        const auto lamp_at = [&](const TrialLamp& place) {
            return flat ? as_flat(surface_, place, glm::normalize(middle_m - place.place_m)) : place;
        };
        const std::vector<double> costs = in_parallel(places.size(), [&](size_t i) {
            if (flat && places[i].place_m == middle_m) return kNoLamp;
            std::vector<TrialLamp> trial = lamps_;
            trial.push_back(lamp_at(places[i]));
            return handicapped(trial, kCoarseSteps, count);
        });
        const auto least = static_cast<size_t>(std::ranges::min_element(costs) - costs.begin());
        const TrialLamp best = lamp_at(places[least]);
        const TrialLamp all_around = try_(std::span(&best.place_m, 1), gpu::kLightSamples).front();
        return is_flat(best) ? as_flat(surface_, all_around, best.axis) : all_around;
    }

    /// Moves each added lamp in turn to the best of the places around it, and turns all lamps, by ever shorter moves.
    /// Returns the cost.
    double move_all() {
        const std::vector<glm::vec3> around = directions();
        double now = handicapped(lamps_);
        if (lamps_.empty()) return now;
        for (float move_m = kFirstMoveM; move_m > kLastMoveM;) {
            std::vector<glm::vec3> places_m;
            for (const TrialLamp& lamp : std::span(lamps_).subspan(given_.lamps.size())) {
                places_m.push_back(lamp.place_m);
                for (const glm::vec3& direction : around) places_m.push_back(lamp.place_m + move_m * direction);
            }
            const std::vector<TrialLamp> tried =
                places_m.empty() ? std::vector<TrialLamp>() : try_(places_m, gpu::kLightSamples);
            const size_t each = around.size() + 1;
            const double before = now;
            for (size_t l = 0; l < given_.lamps.size(); ++l) turn_given(l, kTurnByMove * move_m, now);
            for (size_t l = 0; l < added(); ++l)
                move(given_.lamps.size() + l, std::span(tried).subspan(l * each, each), kTurnByMove * move_m, now);
            if (now > kWorthwhile * before) move_m *= kShorter;
        }
        return now;
    }

    /// Makes a given lamp flat, with the best of all axes, or turns it, or makes it shine all around.
    void turn_given(size_t lamp, float turn, double& now) {
        const TrialLamp& all_around = given_.lamps[lamp];
        const bool flat = is_flat(lamps_[lamp]);
        const glm::vec3 axis = lamps_[lamp].axis;
        std::vector<TrialLamp> changed{lamps_[lamp]};
        for (const glm::vec3& direction : directions())
            changed.push_back(
                as_flat(surface_, all_around, flat ? glm::normalize(axis + turn * direction) : direction));
        changed.push_back(all_around);
        take_best(lamp, changed, now);
    }

    /// The best of these places for a lamp, whose own is the first one; there the best of axes near its own, or none,
    /// if it is flat.
    void move(size_t lamp, std::span<const TrialLamp> places, float turn, double& now) {
        const bool flat = is_flat(lamps_[lamp]);
        const glm::vec3 axis = lamps_[lamp].axis;
        std::vector<TrialLamp> changed;
        for (const TrialLamp& place : places) changed.push_back(flat ? as_flat(surface_, place, axis) : place);
        const TrialLamp& at = places[take_best(lamp, changed, now)];
        if (!flat) return;
        changed.assign(1, lamps_[lamp]);
        for (const glm::vec3& direction : directions())
            changed.push_back(as_flat(surface_, at, glm::normalize(axis + turn * direction)));
        changed.push_back(at);
        take_best(lamp, changed, now);
    }

    /// Changes a lamp, the first of these, to the one that explains most, if that is more than `now`. Which it is.
    size_t take_best(size_t lamp, std::span<const TrialLamp> changed, double& now) {
        const std::vector<double> costs = in_parallel(changed.size(), [&](size_t i) {
            if (i == 0) return now;
            std::vector<TrialLamp> trial = lamps_;
            trial[lamp] = changed[i];
            return handicapped(trial);
        });
        const auto best = static_cast<size_t>(std::ranges::min_element(costs) - costs.begin());
        if (best != 0) lamps_[lamp] = changed[best];
        now = costs[best];
        return best;
    }

    /// Whether the cost without a lamp exceeds `now`, the cost with it, by enough.
    bool is_worthwhile(const TrialLamp& lamp, double without, double now) const {
        const bool expected =
            std::ranges::any_of(seen_m_, [&](glm::vec3 m) { return is_same_place(surface_, lamp.place_m, m); });
        return now < (1 - double{expected ? settings_.expected_gain : settings_.least_gain}) * without;
    }

    /// Leaves out a lamp that matters too little: of these the one without which the others explain most.
    bool remove_one() {
        const double now = cost(lamps_);
        size_t least = lamps_.size();
        double least_cost = 1e9;
        for (size_t l = given_.lamps.size(); l < lamps_.size(); ++l) {
            std::vector<TrialLamp> others = lamps_;
            others.erase(others.begin() + static_cast<ptrdiff_t>(l));
            const double without = cost(others);
            if (without < least_cost && !is_worthwhile(lamps_[l], without, now)) least = l, least_cost = without;
        }
        if (least == lamps_.size()) return false;
        lamps_.erase(lamps_.begin() + static_cast<ptrdiff_t>(least));
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
    const glm::vec3 middle_m = middle_of(surface);
    return glm::distance(a_m, b_m) < kSamePlace * glm::distance(a_m, middle_m);
}

TrialLamp as_flat(const LitSurface& surface, const TrialLamp& all_around, glm::vec3 axis) {
    const Light lamp{
        .position_m = glm::dvec3(all_around.place_m), .intensity = glm::dvec3(1), .axis = glm::dvec3(axis)};
    const auto emission = [&](const gpu::LightSample& sample) {
        return static_cast<float>(intensity_towards(lamp, glm::dvec3(sample.point_m)).x);
    };
    TrialLamp flat = all_around;
    flat.axis = axis;
    auto light = std::make_shared<ReceivedLightValues>();
    light->by_sample.reserve(surface.size());
    for (size_t i = 0; i < surface.size(); ++i) {
        light->by_sample.push_back(all_around.received->by_sample[i] * emission(surface.samples()[i]));
        light->mean += light->by_sample.back() / static_cast<double>(surface.size());
    }
    flat.received = std::move(light);
    for (size_t k = 0; k < flat.unexplained.size(); ++k)
        if (emission(surface.highlights()[k]) <= 0) flat.unexplained[k] = 1;
    return flat;
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
    if (surface.size() == 0) return given.lamps;
    return Search(surface, try_lamps, seen_m, settings, given).run();
}

}  // namespace patina
