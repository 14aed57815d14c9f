#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "reconstruction/lights/search_lights.h"
#include "reconstruction/lights/unseen_light.h"

namespace patina::fit_lights_test {
namespace {

struct Lamp {
    glm::vec3 place_m;
    glm::vec3 intensity;
};

/// What a lamp of intensity 1 gives a surface that nothing shades.
float received(const gpu::LightSample& sample, glm::vec3 place_m) {
    const glm::vec3 offset_m = place_m - glm::vec3(sample.point_m);
    const float distance_m = glm::length(offset_m);
    const float cosine = glm::dot(offset_m, glm::vec3(sample.normal)) / distance_m;
    return std::max(cosine, 0.0f) / (std::numbers::pi_v<float> * distance_m * distance_m);
}

/// Balls on a floor (y points down), of one albedo each but for tiles of the floor, under lamps and ambient light: a
/// sample per place, and highlights on the balls for viewers that see a lamp mirrored.
class Balls {
  public:
    /// Every other tile of the floor, 0.4 m wide, has `dark_tiles` times the albedo of the others.
    Balls(std::vector<Lamp> lamps, glm::vec3 ambient, float noise = 0, float dark_tiles = 1)
        : lamps_(std::move(lamps)), ambient_(ambient), dark_tiles_(dark_tiles) {
        std::normal_distribution<float> normal(0, 1);
        for (uint32_t place = 0; place < gpu::kLightSamples; ++place) {
            if (place % 4 == 3) continue;  // not all places have a sample
            gpu::LightSample sample = place % 2 == 0 ? on_floor() : on_ball(place / 2 % 3);
            sample.diffuse *= 1 + noise * normal(random_);
            drawn_[place] = sample;
        }
        for (uint32_t place = 0; place < 300; ++place) drawn_[gpu::kLightSamples + place] = highlight(place % 3);
    }

    const std::vector<gpu::LightSample>& drawn() const { return drawn_; }

    ReceivedLight received_from(const LitSurface& surface, glm::vec3 place_m) const {
        std::vector<float> row;
        for (uint32_t i = 0; i < gpu::kLightSamples; ++i) row.push_back(received(drawn_[i], place_m));
        return surface.received(row);
    }

    /// From all lamps together, mean of the channels; by place.
    std::vector<float> received_of_all() const {
        std::vector<float> row(gpu::kLightSamples);
        for (uint32_t i = 0; i < gpu::kLightSamples; ++i)
            for (const Lamp& lamp : lamps_)
                row[i] += glm::dot(lamp.intensity, glm::vec3(1)) / 3 * received(drawn_[i], lamp.place_m);
        return row;
    }

    TryLamps try_lamps(const LitSurface& surface) const {
        return [this, &surface](std::span<const glm::vec3> places_m, uint32_t) {
            std::vector<TrialLamp> lamps;
            for (const glm::vec3& place_m : places_m)
                lamps.push_back({place_m, received_from(surface, place_m), surface.unexplained(place_m)});
            return lamps;
        };
    }

  private:
    float uniform(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }

    gpu::LightSample lit(glm::vec3 point_m, glm::vec3 normal, glm::vec3 kd) const {
        gpu::LightSample sample{glm::vec4(point_m, 10), glm::vec4(normal, 0), {}, {}, {}};
        glm::vec3 irradiance = ambient_;
        for (const Lamp& lamp : lamps_) irradiance += lamp.intensity * received(sample, lamp.place_m);
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
};

const std::vector<Lamp> kTwoLamps{{{-1.2f, -1.8f, -0.8f}, {8, 7.5f, 7}}, {{1.5f, -1.6f, 0.6f}, {5, 5, 5.5f}}};

/// Nothing is known of any direction.
KnownLight lamps_alone(const Balls& balls, const LitSurface& surface) {
    const ReceivedLight lamps = surface.received(balls.received_of_all());
    return {lamps, lamps, surface.received(std::vector<float>(gpu::kLightSamples, 1.0f))};
}

TEST(FitUnseenLight, IsWhatKnownLampsLeave) {
    for (const float truth : {0.2f, 0.0f}) {
        const Balls balls(kTwoLamps, glm::vec3(truth), 0.02f);
        const LitSurface surface(balls.drawn(), 1);
        const auto found = fit_unseen_light(surface, lamps_alone(balls, surface));
        ASSERT_TRUE(found);
        EXPECT_NEAR(*found, truth, 0.03f * truth + 0.005f);
    }
}

TEST(FitUnseenLight, DoesNotCountWhatIsKnownToComeFromAround) {
    // Walls send 0.3, in turn from a tenth to nine tenths of all directions; from the others the truth arrives.
    constexpr float kWalls = 0.3f;
    for (const float truth : {0.2f, 0.0f}) {
        const Balls balls(kTwoLamps, glm::vec3(0), 0.02f);
        std::vector<gpu::LightSample> drawn = balls.drawn();
        const std::vector<float> lamps = balls.received_of_all();
        std::vector<float> all = lamps, unknown(gpu::kLightSamples);
        for (uint32_t i = 0; i < gpu::kLightSamples; ++i) {
            unknown[i] = 0.1f * static_cast<float>(1 + i / 4 % 9);
            all[i] += kWalls * (1 - unknown[i]);
            if (lamps[i] == 0) drawn[i].point_m.w = 0;  // its colour was black
            if (lamps[i] > 0) drawn[i].diffuse *= (all[i] + truth * unknown[i]) / lamps[i];
        }
        const LitSurface surface(drawn, 1);
        const KnownLight known{surface.received(lamps), surface.received(all), surface.received(unknown)};
        const auto found = fit_unseen_light(surface, known);
        ASSERT_TRUE(found);
        EXPECT_NEAR(*found, truth, 0.03f * truth + 0.005f);
    }
}

TEST(FitUnseenLight, IsNoMoreThanWhatLampsAloneLeave) {
    const Balls balls(kTwoLamps, glm::vec3(0.1f), 0.02f);
    const LitSurface surface(balls.drawn(), 1);
    KnownLight known = lamps_alone(balls, surface);
    known.unknown = surface.received(std::vector<float>(gpu::kLightSamples, 0.25f));
    const auto found = fit_unseen_light(surface, known);
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, 0.1f, 0.01f) << "0.4 from a quarter of the directions would explain as much";
}

TEST(FitUnseenLight, NothingIsSaidOfSurfaceThatLampsDoNotExplain) {
    const Balls balls(kTwoLamps, glm::vec3(0.2f), 0.5f);
    const LitSurface surface(balls.drawn(), 1);
    EXPECT_FALSE(fit_unseen_light(surface, lamps_alone(balls, surface)));
    const LitSurface nothing(std::vector<gpu::LightSample>(2 * gpu::kLightSamples), 1);
    EXPECT_FALSE(fit_unseen_light(nothing, lamps_alone(balls, nothing)));
}

gpu::LightSample sample_of(float value, float unknown) {
    return {glm::vec4(1), glm::vec4(0), glm::vec4(value), glm::vec4(0), glm::vec4(0, 0, 0, unknown)};
}

// 70 samples of albedo 0.5, 40 of 0.8 and 12 that a sun's patch makes ten times brighter. Half of all directions are
// unknown, and only a part of the light is.
TEST(LeastUnseenLight, MakesNoAlbedoBrighterThanPaint) {
    constexpr float kLamps = 0.6f;
    for (const float unseen : {0.0f, 0.1f, 0.8f}) {
        const float light = kLamps + 0.5f * unseen;
        std::vector<gpu::LightSample> samples;
        for (int i = 0; i < 122; ++i)
            samples.push_back(sample_of((i < 70 ? 0.5f : 0.8f) * light * (i < 110 ? 1.0f : 10.0f), 0.5f));
        for (int i = 0; i < 100; ++i) samples.push_back(sample_of(1e6f, 0.01f));  // it cannot reach these
        for (int i = 0; i < 100; ++i) {
            samples.push_back(sample_of(1e6f, 0.5f));
            samples.back().point_m.w = 0;  // no sample
        }
        const std::vector<float> received(samples.size(), kLamps);
        // The white ones get an albedo of 0.9, where they had more.
        const float expected = std::max((0.8f * light / 0.9f - kLamps) / 0.5f, 0.0f);
        EXPECT_NEAR(least_unseen_light(samples, received), expected, 1e-5f) << unseen;
    }
    EXPECT_EQ(least_unseen_light({}, {}), 0) << "nothing asks for any";
}

TEST(FitIntensities, RatiosOfLampsAndAmbientLightWhereAlbedoIsUnknown) {
    const Balls balls(kTwoLamps, glm::vec3(0.3f));
    const LitSurface surface(balls.drawn(), 1);
    std::vector<ReceivedLight> received;
    for (const Lamp& lamp : kTwoLamps) received.push_back(balls.received_from(surface, lamp.place_m));
    for (int c = 0; c < 3; ++c) {
        const auto fitted = surface.fit(received, 10, surface.size(), static_cast<LightChannel>(c));
        const double factor = fitted.intensities[0] / kTwoLamps[0].intensity[c];
        EXPECT_NEAR(fitted.intensities[1] / factor, kTwoLamps[1].intensity[c], 0.05);
        EXPECT_NEAR(fitted.intensities[2] / factor, 0.3, 0.005);
        EXPECT_LT(fitted.misfit, 1e-4);
    }
}

TEST(FitIntensities, ALampThatIsNotThereGetsNothing) {
    const Balls balls(kTwoLamps, glm::vec3(0), 0.02f);
    const LitSurface surface(balls.drawn(), 1);
    std::vector<ReceivedLight> received;
    for (const Lamp& lamp : kTwoLamps) received.push_back(balls.received_from(surface, lamp.place_m));
    received.push_back(balls.received_from(surface, {0, -2.5f, 2}));
    received.push_back(balls.received_from(surface, {0, 5, 0}));  // below the floor: reaches next to nothing
    const auto fitted = surface.fit(received, 10, surface.size());
    for (const size_t absent : {2u, 3u}) {
        EXPECT_LT(fitted.intensities[absent] * received[absent]->mean, 0.02) << absent;
        EXPECT_GE(fitted.intensities[absent], 0);
    }
}

TEST(FitIntensities, OutliersCountLess) {
    const Balls balls(kTwoLamps, glm::vec3(0.1f));
    std::vector<gpu::LightSample> drawn = balls.drawn();
    for (uint32_t place = 0; place < gpu::kLightSamples; place += 12) drawn[place].diffuse *= 2.5f;
    const LitSurface surface(drawn, 1);
    std::vector<ReceivedLight> received;
    for (const Lamp& lamp : kTwoLamps) received.push_back(balls.received_from(surface, lamp.place_m));
    const auto fitted = surface.fit(received, 10, surface.size());
    EXPECT_NEAR(fitted.intensities[1] / fitted.intensities[0], 5.1667 / 7.5, 0.03);
}

TEST(FitIntensities, TilesOfOneChromaticityHaveTwoAlbedos) {
    for (const float dark_tiles : {0.2f, 0.6f}) {
        const Balls balls(kTwoLamps, glm::vec3(0.3f), 0.02f, dark_tiles);
        const LitSurface surface(balls.drawn(), 1);
        std::vector<ReceivedLight> received;
        for (const Lamp& lamp : kTwoLamps) received.push_back(balls.received_from(surface, lamp.place_m));
        const auto fitted = surface.fit(received, 4, surface.size());
        EXPECT_NEAR(fitted.intensities[1] / fitted.intensities[0], 5.1667 / 7.5, 0.02) << dark_tiles;
        EXPECT_NEAR(fitted.intensities[2] / fitted.intensities[0], 0.3 / 7.5, 0.004) << dark_tiles;
        // The rarer tiles, up to half the floor's, count somewhat as misfit.
        EXPECT_LT(fitted.misfit, 0.1) << dark_tiles;
        EXPECT_GT(fitted.misfit, 0.03) << dark_tiles;
    }
}

TEST(FitIntensities, HighlightsAreExplainedByTheLampThatTheyMirror) {
    const Balls balls(kTwoLamps, glm::vec3(0));
    const LitSurface surface(balls.drawn(), 1);
    const auto first = surface.unexplained(kTwoLamps[0].place_m), second = surface.unexplained(kTwoLamps[1].place_m);
    ASSERT_EQ(first.size(), 300u);
    for (size_t i = 0; i < first.size(); ++i) EXPECT_LT(std::min(first[i], second[i]), 0.1f) << i;
    for (const float share : surface.unexplained({0, 3, 0})) EXPECT_GT(share, 0.9f);
}

TEST(SearchLights, FindsLampsFromShadingAndHighlights) {
    const Balls balls(kTwoLamps, glm::vec3(0.05f), 0.02f);
    const LitSurface surface(balls.drawn(), 1);
    const auto found = search_lights(surface, balls.try_lamps(surface), {}, {});
    ASSERT_EQ(found.size(), 2u);
    for (const Lamp& lamp : kTwoLamps) {
        const float off_m =
            std::min(glm::distance(found[0].place_m, lamp.place_m), glm::distance(found[1].place_m, lamp.place_m));
        EXPECT_LT(off_m, 0.15f);
    }
}

TEST(SearchLights, NothingSeenNothingFound) {
    const LitSurface surface(std::vector<gpu::LightSample>(2 * gpu::kLightSamples), 1);
    EXPECT_EQ(surface.size(), 0u);
    EXPECT_TRUE(search_lights(surface, {}, {}, {}).empty());
}

}  // namespace
}  // namespace patina::fit_lights_test
