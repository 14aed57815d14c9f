// A surface whose lamps are known, for the tests of what finds them.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "reconstruction/lights/search_lights.h"
#include "tests/reference/lighting/lamp_emission.h"
#include "tests/reference/lighting/received.h"

namespace patina {

struct Lamp {
    glm::vec3 place_m;
    glm::vec3 intensity;
    glm::vec3 axis{0};  ///< of a flat one
};

/// What a lamp of intensity 1 gives a surface that nothing shades.
inline float received(const gpu::LightSample& sample, glm::vec3 place_m, glm::vec3 axis = glm::vec3(0)) {
    const glm::dvec3 emitted =
        reference::emitted(glm::dvec3(1), glm::dvec3(axis), glm::dvec3(place_m) - glm::dvec3(sample.point_m));
    return reference::received({glm::vec3(sample.point_m), glm::vec3(sample.normal)}, place_m) *
           static_cast<float>(emitted.x);
}

/// Balls on a floor (y points down), of one albedo each but for tiles of the floor, under lamps and ambient light: a
/// sample per place, and highlights on the balls for viewers that see a lamp mirrored.
class Balls {
  public:
    /// Every other tile of the floor, 0.4 m wide, has `dark_tiles` times the albedo of the others.
    /// `sparse`: half as many samples.
    Balls(std::vector<Lamp> lamps, glm::vec3 ambient, float noise = 0, float dark_tiles = 1, bool sparse = false)
        : lamps_(std::move(lamps)), ambient_(ambient), dark_tiles_(dark_tiles) {
        std::normal_distribution<float> normal(0, 1);
        for (uint32_t place = 0; place < gpu::kLightSamples; ++place) {
            if (place % 4 == 3 || (sparse && place % 8 > 3)) continue;  // not all places have a sample
            gpu::LightSample sample = place % 2 == 0 ? on_floor() : on_ball(place / 2 % 3);
            sample.diffuse *= 1 + noise * normal(random_);
            drawn_[place] = sample;
        }
        for (uint32_t place = 0; place < gpu::kLightSamples; ++place)
            receivers_.push_back({glm::vec3(drawn_[place].point_m), glm::vec3(drawn_[place].normal)});
        for (uint32_t place = 0; place < 300; ++place) drawn_[gpu::kLightSamples + place] = highlight(place % 3);
    }

    const std::vector<gpu::LightSample>& drawn() const { return drawn_; }

    ReceivedLight received_from(const LitSurface& surface, glm::vec3 place_m) const {
        return surface.received(reference::received(receivers_, place_m));
    }

    /// From all lamps together, mean of the channels; by place.
    std::vector<float> received_of_all() const {
        std::vector<float> row(gpu::kLightSamples);
        for (uint32_t i = 0; i < gpu::kLightSamples; ++i)
            for (const Lamp& lamp : lamps_)
                row[i] += glm::dot(lamp.intensity, glm::vec3(1)) / 3 * received(drawn_[i], lamp.place_m, lamp.axis);
        return row;
    }

    TrialLamp tried(const LitSurface& surface, glm::vec3 place_m) const {
        return {.place_m = place_m,
                .received = received_from(surface, place_m),
                .unexplained = surface.unexplained(place_m)};
    }

    TryLamps try_lamps(const LitSurface& surface) const {
        return [this, &surface](std::span<const glm::vec3> places_m, uint32_t) {
            std::vector<TrialLamp> lamps;
            for (const glm::vec3& place_m : places_m) lamps.push_back(tried(surface, place_m));
            return lamps;
        };
    }

  private:
    float uniform(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }

    gpu::LightSample lit(glm::vec3 point_m, glm::vec3 normal, glm::vec3 kd) const {
        gpu::LightSample sample{glm::vec4(point_m, 10), glm::vec4(normal, 0), {}, {}, {}};
        glm::vec3 irradiance = ambient_;
        for (const Lamp& lamp : lamps_) irradiance += lamp.intensity * received(sample, lamp.place_m, lamp.axis);
        sample.diffuse = glm::vec4(kd * irradiance, 0);
        return sample;
    }

    gpu::LightSample on_floor() {
        const glm::vec3 point_m(uniform(-2, 2), 0, uniform(-2, 2));
        const bool dark = (std::lround(point_m.x / 0.4f) + std::lround(point_m.z / 0.4f)) % 2 != 0;
        return lit(point_m, {0, -1, 0}, (dark ? dark_tiles_ : 1) * glm::vec3(0.34f, 0.33f, 0.3f));
    }

    gpu::LightSample on_ball(uint32_t ball) {
        const glm::vec3 normal =
            glm::normalize(glm::vec3(uniform(-1, 1), uniform(-1, 0.3f), uniform(-1, 1)) + glm::vec3(0, 1e-3f, 0));
        return lit(kCenters[ball] + 0.3f * normal, normal, kAlbedos[ball]);
    }

    /// Seen from above, within a few degrees of the mirrored direction.
    gpu::LightSample highlight(uint32_t ball) {
        const Lamp& lamp = lamps_[static_cast<size_t>(uniform(0, 0.999f) * static_cast<float>(lamps_.size()))];
        const glm::vec3 normal = glm::normalize(glm::vec3(uniform(-0.7f, 0.7f), -1, uniform(-0.7f, 0.7f)));
        gpu::LightSample sample = lit(kCenters[ball] + 0.3f * normal, normal, kAlbedos[ball]);
        const glm::vec3 to_light = glm::normalize(lamp.place_m - glm::vec3(sample.point_m));
        if (glm::dot(to_light, normal) < 0.4f) return highlight(ball);
        const glm::vec3 off(uniform(-0.05f, 0.05f), uniform(-0.05f, 0.05f), uniform(-0.05f, 0.05f));
        const glm::vec3 viewer = glm::normalize(2 * glm::dot(to_light, normal) * normal - to_light + off);
        sample.highlight = glm::vec4(viewer, 0.3f);
        return sample;
    }

    inline static const glm::vec3 kCenters[] = {{-0.9f, -0.3f, -0.2f}, {0.2f, -0.3f, 0.6f}, {0.8f, -0.3f, -0.7f}};
    inline static const glm::vec3 kAlbedos[] = {{0.5f, 0.1f, 0.08f}, {0.1f, 0.4f, 0.12f}, {0.1f, 0.2f, 0.6f}};

    std::vector<Lamp> lamps_;
    glm::vec3 ambient_;
    float dark_tiles_;
    std::mt19937 random_{5};
    std::vector<gpu::LightSample> drawn_ = std::vector<gpu::LightSample>(2 * gpu::kLightSamples);
    std::vector<reference::Receiver> receivers_;  ///< by place, of the first half of drawn_
};

inline const std::vector<Lamp> kTwoLamps{{{-1.2f, -1.8f, -0.8f}, {8, 7.5f, 7}}, {{1.5f, -1.6f, 0.6f}, {5, 5, 5.5f}}};

/// Half as many samples, for searches, which then take half as long.
inline Balls sparse_balls(std::vector<Lamp> lamps, glm::vec3 ambient, float noise) {
    return {std::move(lamps), ambient, noise, 1, true};
}

}  // namespace patina
