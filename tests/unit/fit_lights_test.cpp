#include <cmath>

#include <gtest/gtest.h>

#include "reconstruction/lights/search_lights.h"
#include "reconstruction/lights/unseen_light.h"
#include "tests/unit/lit_balls.h"

namespace patina::fit_lights_test {
namespace {

/// Nothing is known of any direction.
KnownLight lamps_alone(const Balls& balls, const LitSurface& surface) {
    const ReceivedLight lamps = surface.received(balls.received_of_all());
    return {lamps, lamps, surface.received(std::vector<float>(gpu::kLightSamples, 1.0f))};
}

/// Lamps, and walls that send 0.3 from all but a tenth to nine tenths of all directions, in turn.
struct LitRoom {
    static constexpr float kWalls = 0.3f;

    /// `unseen`: what arrives from the other directions.
    LitRoom(const Balls& balls, float unseen) : drawn(balls.drawn()), lamps(balls.received_of_all()) {
        all = lamps;
        unknown.resize(gpu::kLightSamples);
        for (uint32_t i = 0; i < gpu::kLightSamples; ++i) {
            unknown[i] = 0.1f * static_cast<float>(1 + i / 4 % 9);
            all[i] += kWalls * (1 - unknown[i]);
            if (lamps[i] == 0) drawn[i].point_m.w = 0;  // its colour was black
            if (lamps[i] > 0) drawn[i].diffuse *= (all[i] + unseen * unknown[i]) / lamps[i];
        }
    }

    KnownLight known_on(const LitSurface& surface) const {
        return {surface.received(lamps), surface.received(all), surface.received(unknown)};
    }

    std::vector<gpu::LightSample> drawn;
    std::vector<float> lamps, all, unknown;
};

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
    for (const float truth : {0.2f, 0.0f}) {
        const LitRoom room(Balls(kTwoLamps, glm::vec3(0), 0.02f), truth);
        const LitSurface surface(room.drawn, 1);
        const auto found = fit_unseen_light(surface, room.known_on(surface));
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

TEST(LikelyUnseenLight, IsWhatKnownLightLeaves) {
    for (const float share : {0.0f, 0.3f, 0.7f, 1.0f, 2.6f}) {
        const LitRoom room(Balls(kTwoLamps, glm::vec3(0), 0.02f), share * LitRoom::kWalls);
        const LitSurface surface(room.drawn, 1);
        const UnseenLight found = likely_unseen_light(surface, room.known_on(surface), double{LitRoom::kWalls});
        EXPECT_NEAR(found.radiance, share * LitRoom::kWalls, 0.03);
        EXPECT_LT(found.misfit, 0.05);
    }
}

TEST(LikelyUnseenLight, IsNoneWhereLampsStandInAVoid) {
    const Balls balls(kTwoLamps, glm::vec3(0), 0.02f);
    const LitSurface surface(balls.drawn(), 1);
    EXPECT_EQ(likely_unseen_light(surface, lamps_alone(balls, surface), 0.2).radiance, 0);
}

TEST(LikelyUnseenLight, IsAsMuchAsElsewhereWhereNothingTellsIt) {
    std::vector<gpu::LightSample> drawn = Balls(kTwoLamps, glm::vec3(0)).drawn();
    for (gpu::LightSample& sample : drawn) sample.diffuse = glm::vec4(0.2f);
    const LitSurface surface(drawn, 1);
    const ReceivedLight same = surface.received(std::vector<float>(gpu::kLightSamples, 0.5f));
    EXPECT_EQ(likely_unseen_light(surface, {same, same, same}, 0.3).radiance, 0.3);
}

TEST(LikelyUnseenLight, LampsOfAnyStrengthStandBesideIt) {
    const LitRoom room(Balls(kTwoLamps, glm::vec3(0), 0.02f), 0.5f * LitRoom::kWalls);
    const LitSurface surface(room.drawn, 1);
    std::vector<float> rest = room.all;
    const std::vector<float> second = Balls({kTwoLamps[1]}, glm::vec3(0)).received_of_all();
    for (uint32_t i = 0; i < gpu::kLightSamples; ++i) rest[i] -= second[i];
    const ReceivedLight lamp = surface.received(second);
    KnownLight known = room.known_on(surface);
    known.all = surface.received(rest);
    const UnseenLight found = likely_unseen_light(surface, known, double{LitRoom::kWalls}, std::span(&lamp, 1));
    EXPECT_NEAR(found.radiance, 0.5 * double{LitRoom::kWalls}, 0.03);
}

TEST(LikelyUnseenLight, SurfaceThatNothingExplainsHasALargeMisfit) {
    const LitRoom room(Balls(kTwoLamps, glm::vec3(0.2f), 0.5f), 0.1f);
    const LitSurface surface(room.drawn, 1);
    EXPECT_GT(likely_unseen_light(surface, room.known_on(surface), double{LitRoom::kWalls}).misfit, 0.15);
}

std::optional<glm::vec3> chosen(float noise, bool beside_sun) {
    const LitRoom room(Balls(kTwoLamps, glm::vec3(0), noise), 0.5f * LitRoom::kWalls);
    const LitSurface surface(room.drawn, 1);
    const glm::vec3 usual = LitRoom::kWalls * glm::vec3(1.5f, 1, 0.5f);
    return choose_unseen_light(surface, room.known_on(surface), usual, beside_sun);
}

TEST(ChooseUnseenLight, IsWhiteAsFittedWhereSurfaceIsExplainedWell) {
    const auto light = chosen(0.02f, false);
    ASSERT_TRUE(light);
    EXPECT_NEAR(light->g, 0.5f * LitRoom::kWalls, 0.01f);
    EXPECT_EQ(*light, glm::vec3(light->g));
    EXPECT_EQ(chosen(0.02f, true), glm::vec3(0)) << "a sun's soft borders would be taken for it";
}

TEST(ChooseUnseenLight, IsLikelyAndTintedWhereSurfaceIsExplainedLessWell) {
    for (const bool beside_sun : {false, true}) {
        const auto light = chosen(0.09f, beside_sun);
        ASSERT_TRUE(light);
        EXPECT_NEAR(light->g, 0.5f * LitRoom::kWalls, 0.08f);
        EXPECT_NEAR(light->r / light->g, 1.5f, 1e-4f);
        EXPECT_NEAR(light->b / light->g, 0.5f, 1e-4f);
    }
}

TEST(ChooseUnseenLight, IsNotToldWhereNothingExplainsSurface) { EXPECT_FALSE(chosen(0.5f, false)); }

TEST(UsualLight, IsWhatKnownDirectionsSend) {
    const auto around = [](float observations, glm::vec4 light) {
        gpu::LightSample sample{};
        sample.point_m.w = observations;
        sample.around = light;
        return sample;
    };
    const std::vector<gpu::LightSample> samples = {around(5, {0.2f, 0.1f, 0, 0.5f}), around(5, {0.1f, 0.2f, 0.3f, 0}),
                                                   around(5, {0, 0, 0, 1}), around(0, {9, 9, 9, 0}),
                                                   around(5, {0, 0, 0, -1})};
    const glm::vec3 light = usual_light(samples);
    EXPECT_NEAR(light.r, 0.2f, 1e-6f);
    EXPECT_NEAR(light.g, 0.2f, 1e-6f);
    EXPECT_NEAR(light.b, 0.2f, 1e-6f);
    EXPECT_EQ(usual_light({}), glm::vec3(0));
}

std::vector<gpu::LightSample> with_unknown_share(size_t count, float share) {
    gpu::LightSample sample{};
    sample.point_m.w = 5;
    sample.around.w = share;
    return std::vector(count, sample);
}

TEST(UnknownShare, IsThatOfSamplesOfWhichItWasLooked) {
    std::vector<gpu::LightSample> samples = with_unknown_share(3, 0.2f);
    const auto add = [&](const std::vector<gpu::LightSample>& more) {
        samples.insert(samples.end(), more.begin(), more.end());
    };
    add(with_unknown_share(1, 1));
    add(with_unknown_share(9, -1));      // nobody looked
    samples.resize(gpu::kLightSamples);  // no samples
    add(with_unknown_share(9, 0));       // highlights
    EXPECT_NEAR(unknown_share(samples), 0.4, 1e-6);
    EXPECT_EQ(unknown_share({}), 1);
    EXPECT_TRUE(is_enough_around(samples));
    EXPECT_FALSE(is_enough_around(with_unknown_share(9, 0.8f))) << "a table";
}

TEST(EnoughSurface, IsAQuarterOfAllPlacesOfSamples) {
    EXPECT_TRUE(is_enough_surface(with_unknown_share(gpu::kLightSamples / 4, 0.2f)));
    EXPECT_FALSE(is_enough_surface(with_unknown_share(gpu::kLightSamples / 4 - 1, 0.2f)));
    EXPECT_FALSE(is_enough_surface(with_unknown_share(gpu::kLightSamples, -1))) << "nobody looked around";
}

TEST(SurfaceLight, IsTheMedianOfWhatTheSurfaceSends) {
    const auto sends = [](float observations, glm::vec3 light) {
        gpu::LightSample sample{};
        sample.point_m.w = observations;
        sample.diffuse = glm::vec4(light, 0);
        return sample;
    };
    std::vector<gpu::LightSample> samples(200, sends(5, {0.1f, 0.2f, 0.3f}));
    samples.insert(samples.end(), 50, sends(3, {4, 3, 2}));             // a patch of sun
    samples.insert(samples.end(), 49, sends(3, {0.05f, 0.02f, 0.1f}));  // black tiles
    samples.resize(gpu::kLightSamples, sends(0, {9, 9, 9}));            // no samples
    samples.resize(2 * gpu::kLightSamples, sends(5, {9, 9, 9}));        // highlights
    EXPECT_EQ(surface_light(samples), glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(surface_light(std::vector(7, sends(0, {9, 9, 9}))), glm::vec3(0));
}

LitRoom looked_around(float noise) {
    LitRoom room(Balls(kTwoLamps, glm::vec3(0), noise), 0.5f * LitRoom::kWalls);
    for (uint32_t i = 0; i < gpu::kLightSamples; ++i)
        room.drawn[i].around = glm::vec4(glm::vec3(LitRoom::kWalls * (1 - room.unknown[i])), room.unknown[i]);
    return room;
}

glm::vec3 decided(float noise, UnseenLightBounds bounds) {
    const LitRoom room = looked_around(noise);
    const LitSurface surface(room.drawn, 1);
    const auto chosen = choose_unseen_light(surface, room.known_on(surface), usual_light(room.drawn), false);
    return decide_unseen_light(chosen, room.drawn, bounds);
}

TEST(DecideUnseenLight, IsAtLeastWhatSurfacesAskForWhereItIsExplained) {
    EXPECT_NEAR(decided(0.02f, {}).g, 0.5f * LitRoom::kWalls, 0.01f);
    EXPECT_NEAR(decided(0.02f, {.least = 1}).g, 1, 1e-6f);
}

TEST(DecideUnseenLight, IsAtMostWhatLeavesWhiteSurfacesWhite) {
    EXPECT_NEAR(decided(0.02f, {.most = 0.05f}).g, 0.05f, 1e-6f);
    EXPECT_NEAR(decided(0.5f, {.most = 0.05f}).g, 0.05f, 0.05f) << "also where nothing explains the surface";
    EXPECT_GT(decided(0.02f, {.most = 0}).g, 0) << "no light at all would count as not known";
}

TEST(DecideUnseenLight, IsWhatTheSurfaceSendsWhereNothingExplainsIt) {
    EXPECT_EQ(decided(0.5f, {.least = 1}), surface_light(looked_around(0.5f).drawn));
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
    std::vector<gpu::LightSample> drawn(gpu::kLightSamples, sample_of(0.3f, 0.5f));
    drawn.resize(2 * gpu::kLightSamples, sample_of(9, 0.5f));
    EXPECT_EQ(least_unseen_light(drawn, std::vector(gpu::kLightSamples, 1.0f)), 0) << "highlights are no samples";
}

// 80 samples of albedo 0.4 and 20 of 0.7, half of whose directions are unknown.
TEST(MostUnseenLight, LeavesATenthOfTheSurfaceNearlyWhite) {
    constexpr float kLamps = 0.6f, kUnseen = 0.2f;
    std::vector<gpu::LightSample> samples;
    for (int i = 0; i < 100; ++i)
        samples.push_back(sample_of((i < 80 ? 0.4f : 0.7f) * (kLamps + 0.5f * kUnseen), 0.5f));
    samples.push_back(sample_of(1e6f, -1));  // nobody looked around
    const std::vector<float> received(samples.size(), kLamps);
    const float most = most_unseen_light(samples, received, 0.8f);
    EXPECT_NEAR(0.7f * (kLamps + 0.5f * kUnseen) / (kLamps + 0.5f * most), 0.6f, 1e-4f);
    EXPECT_EQ(most_unseen_light(samples, std::vector(samples.size(), 9.0f), 0.8f), 0) << "lamps alone are too much";
    EXPECT_GT(most_unseen_light({}, {}, 0.8f), 1e6f) << "nothing tells it";
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
    const Balls balls = sparse_balls(kTwoLamps, glm::vec3(0.05f), 0.02f);
    const LitSurface surface(balls.drawn(), 1);
    const auto found = search_lights(surface, balls.try_lamps(surface), {}, {});
    ASSERT_EQ(found.size(), 2u);
    for (const Lamp& lamp : kTwoLamps) {
        const float off_m =
            std::min(glm::distance(found[0].place_m, lamp.place_m), glm::distance(found[1].place_m, lamp.place_m));
        EXPECT_LT(off_m, 0.15f);
    }
    for (const TrialLamp& lamp : found) EXPECT_EQ(lamp.axis, glm::vec3(0)) << "nothing speaks for a flat one";
}

// Highlights are left out: they tell the place without the axis.
TEST(SearchLights, FindsAFlatLampAndItsAxis) {
    const std::vector<Lamp> lamps{kTwoLamps[0], {{1.3f, -1.7f, 0.4f}, {9, 9, 9}, glm::normalize(glm::vec3(-1, 1, 0))}};
    const Balls balls = sparse_balls(lamps, glm::vec3(0.05f), 0.02f);
    const LitSurface surface(balls.drawn(), 1);
    const auto found = search_lights(surface, balls.try_lamps(surface), {}, {.most_lamps = 2, .highlight_share = 0});
    ASSERT_EQ(found.size(), 2u);
    const bool in_order = found[1].axis != glm::vec3(0);
    EXPECT_LT(glm::distance(found[in_order ? 0 : 1].place_m, lamps[0].place_m), 0.15f);
    EXPECT_EQ(found[in_order ? 0 : 1].axis, glm::vec3(0));
    EXPECT_LT(glm::distance(found[in_order ? 1 : 0].place_m, lamps[1].place_m), 0.15f);
    EXPECT_GT(glm::dot(found[in_order ? 1 : 0].axis, lamps[1].axis), std::cos(glm::radians(10.0f)));
}

TEST(SearchLights, AFlatLampGivesNothingAndMirrorsNothingBehindIt) {
    const Balls balls(kTwoLamps, glm::vec3(0));
    const LitSurface surface(balls.drawn(), 1);
    const TrialLamp around = balls.try_lamps(surface)(std::span(&kTwoLamps[0].place_m, 1), 0).front();
    const glm::vec3 axis = glm::normalize(glm::vec3(-1, 0.5f, 0));
    const TrialLamp flat = as_flat(surface, around, axis);
    double mean = 0;
    for (size_t i = 0; i < surface.size(); ++i) {
        const float expected = received(surface.samples()[i], around.place_m, axis);
        EXPECT_NEAR(flat.received->by_sample[i], expected, 1e-5f);
        mean += expected / static_cast<double>(surface.size());
    }
    EXPECT_NEAR(flat.received->mean, mean, 1e-5);
    size_t behind = 0;
    for (size_t k = 0; k < surface.highlights().size(); ++k) {
        const glm::vec3 way_m = glm::vec3(surface.highlights()[k].point_m) - around.place_m;
        EXPECT_EQ(flat.unexplained[k], glm::dot(way_m, axis) > 0 ? around.unexplained[k] : 1);
        behind += glm::dot(way_m, axis) <= 0;
    }
    EXPECT_GT(behind, 0u);
    EXPECT_EQ(flat.place_m, around.place_m);
    EXPECT_EQ(flat.axis, axis);
}

// Two lamps a metre apart: without either of them, where it stands, much is unexplained; one between them explains
// nearly all.
TEST(SearchLights, ALampMustBeWorthHavingBesideTheBestOfFewer) {
    const glm::vec3 middle_m{0.2f, -1.5f, 0.1f};
    const std::vector<Lamp> lamps{{middle_m - glm::vec3(0.5f, 0, 0), {5, 5, 5}},
                                  {middle_m + glm::vec3(0.5f, 0, 0), {5, 5, 5}}};
    const Balls balls = sparse_balls(lamps, glm::vec3(0.05f), 0.02f);
    const LitSurface surface(balls.drawn(), 1);
    const auto found = search_lights(surface, balls.try_lamps(surface), {}, {.most_lamps = 2, .highlight_share = 0});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_LT(glm::distance(found[0].place_m, middle_m), 0.3f);
}

// What makes a weak lamp worth having is less where one is expected.
TEST(SearchLights, AWeakLampIsFoundWhereOneIsExpected) {
    std::vector<Lamp> lamps(kTwoLamps.begin(), kTwoLamps.end());
    lamps[1].intensity *= 0.07f;
    const Balls balls = sparse_balls(lamps, glm::vec3(0.05f), 0.02f);
    const LitSurface surface(balls.drawn(), 1);
    const LightSearchSettings settings{.most_lamps = 2, .highlight_share = 0, .expected_gain = 0.06f};
    for (size_t expected = 0; expected < 2; ++expected) {
        const auto found =
            search_lights(surface, balls.try_lamps(surface), std::span(&lamps[expected].place_m, 1), settings);
        EXPECT_EQ(found.size(), expected + 1);
    }
}

TEST(SearchLights, NothingSeenNothingFound) {
    const LitSurface surface(std::vector<gpu::LightSample>(2 * gpu::kLightSamples), 1);
    EXPECT_EQ(surface.size(), 0u);
    EXPECT_TRUE(search_lights(surface, {}, {}, {}).empty());
}

}  // namespace
}  // namespace patina::fit_lights_test
