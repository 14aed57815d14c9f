#include "passes/light_fitting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "engine/core/error.h"
#include "passes/lighting/sample_surface.h"

namespace patina {
namespace {

constexpr uint32_t kCoarsePlaces = 1024;  // of the samples, from which new lamps are judged
constexpr uint32_t kCoarseSteps = 3, kFineSteps = 4, kFinalSteps = 10;
constexpr double kMostPlaces = 1500;                                              // that a new lamp may have
constexpr float kMarginShare = 0.35f, kLeastMarginM = 0.5f, kMostMarginM = 2.5f;  // around what was seen
constexpr float kFirstMoveM = 0.3f, kLastMoveM = 0.03f, kShorter = 0.6f;
constexpr float kLeastDistanceM = 0.15f;  // of a lamp from the surface
constexpr float kBrightAlbedo = 0.8f, kBrightQuantile = 0.95f;

/// Axes and diagonals.
std::vector<glm::vec3> directions() {
    std::vector<glm::vec3> all;
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0f, 1.0f}) {
            glm::vec3 d(0);
            d[axis] = sign;
            all.push_back(d);
        }
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 d((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1);
        all.push_back(d / std::sqrt(3.0f));
    }
    return all;
}

/// A lamp's place, what it gives the samples, and which highlights it does not explain.
struct Lamp {
    glm::vec3 place_m{0};
    ReceivedLight received;
    std::vector<float> unexplained;
};

std::vector<ReceivedLight> received_by(std::span<const Lamp> lamps) {
    std::vector<ReceivedLight> received;
    for (const Lamp& lamp : lamps) received.push_back(lamp.received);
    return received;
}

class Search {
  public:
    Search(Reconstruction& reconstruction, const LightFittingSettings& settings)
        : reconstruction_(reconstruction),
          settings_(settings),
          drawn_(draw(reconstruction)),
          surface_(drawn_, settings.cell_m),
          coarse_(surface_.samples_before(kCoarsePlaces)) {}

    bool has_samples() const { return coarse_ > 0; }

    void run(std::span<const glm::vec3> seen_m) {
        const std::vector<Lamp> places = try_all(places_of(seen_m), kCoarsePlaces);
        double best = cost(lamps_, kFineSteps);
        while (lamps_.size() < settings_.most_lamps) {
            const std::vector<Lamp> before = lamps_;
            lamps_.push_back(best_addition(places));
            move_all();
            const double now = cost(lamps_, kFineSteps);
            // Two lamps may be needed where neither alone helps.
            if (now > (1 - 0.5 * settings_.least_gain) * best) {
                lamps_ = before;
                break;
            }
            best = now;
        }
        while (remove_one()) move_all();
    }

    FittedLights result() const {
        FittedLights fitted;
        const std::vector<ReceivedLight> received = received_by(lamps_);
        std::array<FittedIntensities, 3> channels;
        for (int c = 0; c < 3; ++c)
            channels[c] = surface_.fit(received, kFinalSteps, surface_.size(), static_cast<LightChannel>(c));
        const double scale = brightest_albedo(channels) / kBrightAlbedo;
        for (size_t l = 0; l < lamps_.size(); ++l) {
            FoundLight lamp;
            lamp.position_m = lamps_[l].place_m;
            for (int c = 0; c < 3; ++c) lamp.intensity[c] = static_cast<float>(scale * channels[c].intensities[l]);
            measure_highlights(l, lamp);
            fitted.lamps.push_back(lamp);
        }
        for (int c = 0; c < 3; ++c) fitted.ambient[c] = static_cast<float>(scale * channels[c].intensities.back());
        const auto total = [](const FoundLight& l) { return l.intensity.r + l.intensity.g + l.intensity.b; };
        std::stable_sort(fitted.lamps.begin(), fitted.lamps.end(),
                         [&](const FoundLight& a, const FoundLight& b) { return total(a) > total(b); });
        fitted.misfit = static_cast<float>(surface_.fit(received, kFinalSteps, surface_.size()).misfit);
        fitted.unexplained = static_cast<float>(unexplained(lamps_));
        return fitted;
    }

  private:
    static std::vector<gpu::LightSample> draw(Reconstruction& reconstruction) {
        const ReflectanceModel* reflectance = reconstruction.reflectance();
        if (!reflectance) throw Error("lights cannot be found in a reconstruction without reflectance");
        graph::Frame frame = reconstruction.runner().begin();
        const ObservationMap& map = reflectance->observations();
        const graph::Readback samples = frame.read_back(add_sample_surface(frame, map, map.import(frame)));
        reconstruction.runner().submit(std::move(frame));
        reconstruction.wait();
        return samples.as<gpu::LightSample>();
    }

    /// A lattice around all samples, then what was seen.
    std::vector<glm::vec3> places_of(std::span<const glm::vec3> seen_m) const {
        glm::vec3 low(1e9f), high(-1e9f);
        for (const gpu::LightSample& sample : surface_.samples()) {
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

    /// Lamps at these places, with the light of the first `count` places of samples.
    std::vector<Lamp> try_all(const std::vector<glm::vec3>& places_m, uint32_t count) const {
        std::vector<Lamp> lamps;
        for (size_t first = 0; first < places_m.size(); first += gpu::kTrialLights) {
            const size_t some = std::min<size_t>(gpu::kTrialLights, places_m.size() - first);
            const std::span<const glm::vec3> batch(places_m.data() + first, some);
            graph::Frame frame = reconstruction_.runner().begin();
            const auto samples = frame.upload<gpu::LightSample>("lighting.samples", drawn_);
            const VoxelMap& map = reconstruction_.map();
            const graph::Readback read =
                frame.read_back(add_try_lights(frame, map, map.import(frame), samples, batch, count));
            reconstruction_.runner().submit(std::move(frame));
            reconstruction_.wait();
            const auto received = read.as<float>();
            for (size_t i = 0; i < some; ++i) {
                const std::span<const float> row(received.data() + i * gpu::kLightSamples, gpu::kLightSamples);
                lamps.push_back({batch[i], surface_.received(row), surface_.unexplained(batch[i])});
            }
        }
        return lamps;
    }

    /// Share of the highlights that none of the lamps explains.
    double unexplained(std::span<const Lamp> lamps) const {
        double sum = 0, total = 0;
        for (size_t i = 0; i < surface_.highlights().size(); ++i) {
            float least = 1;
            for (const Lamp& lamp : lamps) least = std::min(least, lamp.unexplained[i]);
            const double strength = surface_.highlights()[i].highlight.w;
            sum += strength * least;
            total += strength;
        }
        return total > 0 ? sum / total : 0;
    }

    double cost(std::span<const Lamp> lamps, uint32_t steps, std::optional<size_t> count = {}) const {
        const FittedIntensities fitted = surface_.fit(received_by(lamps), steps, count.value_or(surface_.size()));
        return fitted.misfit + settings_.highlight_share * unexplained(lamps);
    }

    Lamp best_addition(const std::vector<Lamp>& places) const {
        std::vector<Lamp> trial = lamps_;
        trial.emplace_back();
        const Lamp* best = nullptr;
        double least = 1e9;
        for (const Lamp& place : places) {
            trial.back() = place;
            const double value = cost(trial, kCoarseSteps, coarse_);
            if (value < least) best = &place, least = value;
        }
        return try_all({best->place_m}, gpu::kLightSamples).front();
    }

    /// Moves each lamp in turn to the best of the places around it, by ever shorter moves.
    void move_all() {
        static const std::vector<glm::vec3> kDirections = directions();
        double now = cost(lamps_, kFineSteps);
        for (float move_m = kFirstMoveM; move_m > kLastMoveM;) {
            std::vector<glm::vec3> places;
            for (const Lamp& lamp : lamps_)
                for (const glm::vec3& direction : kDirections) places.push_back(lamp.place_m + move_m * direction);
            const std::vector<Lamp> tried = try_all(places, gpu::kLightSamples);
            const double before = now;
            for (size_t l = 0; l < lamps_.size(); ++l) {
                std::vector<Lamp> trial = lamps_;
                for (size_t d = 0; d < kDirections.size(); ++d) {
                    trial[l] = tried[l * kDirections.size() + d];
                    const double value = cost(trial, kFineSteps);
                    if (value < now) lamps_[l] = trial[l], now = value;
                }
            }
            if (now > 0.998 * before) move_m *= kShorter;
        }
    }

    /// Leaves out the lamp that matters least, if it matters too little.
    bool remove_one() {
        const double now = cost(lamps_, kFineSteps);
        double least = 1e9;
        std::vector<Lamp> best;
        for (size_t l = 0; l < lamps_.size(); ++l) {
            std::vector<Lamp> trial = lamps_;
            trial.erase(trial.begin() + static_cast<ptrdiff_t>(l));
            const double value = cost(trial, kFineSteps);
            if (value < least) best = trial, least = value;
        }
        if (lamps_.empty() || now < (1 - settings_.least_gain) * least) return false;
        lamps_ = best;
        return true;
    }

    /// What the brightest samples' albedo is when every sample receives 1 on the mean.
    double brightest_albedo(const std::array<FittedIntensities, 3>& channels) const {
        std::vector<float> albedo;
        for (size_t g = 0; g < channels[0].albedo.size(); ++g)
            albedo.push_back(std::max({channels[0].albedo[g], channels[1].albedo[g], channels[2].albedo[g]}));
        if (albedo.empty()) return kBrightAlbedo;
        const auto at = static_cast<size_t>(kBrightQuantile * static_cast<float>(albedo.size() - 1));
        std::nth_element(albedo.begin(), albedo.begin() + static_cast<ptrdiff_t>(at), albedo.end());
        return albedo[at];
    }

    /// Those of the highlights that this lamp explains best.
    void measure_highlights(size_t lamp, FoundLight& found) const {
        std::vector<float> off_m;
        for (size_t i = 0; i < surface_.highlights().size(); ++i) {
            const float own = lamps_[lamp].unexplained[i];
            const bool best = std::all_of(lamps_.begin(), lamps_.end(),
                                          [&](const Lamp& other) { return other.unexplained[i] >= own; });
            if (!best || own > 0.5f) continue;
            const gpu::LightSample& sample = surface_.highlights()[i];
            const glm::vec3 normal(sample.normal), viewer(sample.highlight);
            const glm::vec3 mirrored = 2 * glm::dot(viewer, normal) * normal - viewer;
            off_m.push_back(glm::length(glm::cross(found.position_m - glm::vec3(sample.point_m), mirrored)));
        }
        found.sightings = static_cast<uint32_t>(off_m.size());
        if (off_m.empty()) return;
        const auto middle = off_m.begin() + static_cast<ptrdiff_t>(off_m.size() / 2);
        std::nth_element(off_m.begin(), middle, off_m.end());
        found.spread_m = *middle;
    }

    Reconstruction& reconstruction_;
    LightFittingSettings settings_;
    std::vector<gpu::LightSample> drawn_;
    LitSurface surface_;
    size_t coarse_;
    std::vector<Lamp> lamps_;
};

}  // namespace

FittedLights fit_lights(Reconstruction& reconstruction, std::span<const glm::vec3> seen_m,
                        const LightFittingSettings& settings) {
    Search search(reconstruction, settings);
    if (!search.has_samples()) return {};
    search.run(seen_m);
    return search.result();
}

}  // namespace patina
