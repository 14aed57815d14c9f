#include "reconstruction/lights/unmeasured_lamps.h"

#include <gtest/gtest.h>

#include "tests/unit/lit_balls.h"

namespace patina::unmeasured_lamps_test {
namespace {

const glm::vec3 kBefore_m = kTwoLamps[1].place_m + glm::vec3(0.3f, 0.2f, -0.1f);

/// All is known of the first of two lamps, and of all directions but a share.
MeasuredLight first_lamp(const Balls& balls, float unknown) {
    MeasuredLight measured{.known = {}, .unknown = std::vector<float>(gpu::kLightSamples, unknown)};
    const Lamp& lamp = kTwoLamps[0];
    for (uint32_t i = 0; i < gpu::kLightSamples; ++i)
        measured.known.push_back(lamp.intensity * received(balls.drawn()[i], lamp.place_m));
    return measured;
}

void expect_second_lamp(glm::vec3 intensity, double share) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(intensity[c], kTwoLamps[1].intensity[c], share * kTwoLamps[1].intensity[c]) << c;
}

TEST(UnmeasuredLamps, ALampThatNoPictureShowsIsFoundBesideAMeasuredOne) {
    const Balls balls = sparse_balls(kTwoLamps, glm::vec3(0), 0.02f);
    const LitSurface surface(balls.drawn(), 1);
    const UnmeasuredLamps told =
        fit_unmeasured_lamps(surface, first_lamp(balls, 0.1f), {}, std::span(&kBefore_m, 1), balls.try_lamps(surface));
    EXPECT_TRUE(told.clipped.empty());
    ASSERT_EQ(told.added.size(), 1u);
    EXPECT_LT(glm::distance(glm::vec3(told.added[0].position_m), kTwoLamps[1].place_m), 0.15f);
    expect_second_lamp(glm::vec3(told.added[0].intensity), 0.1);
}

/// What is told of the second of two lamps, which is clipped, beside the first.
UnmeasuredLamps told_of_clipped(const std::vector<Lamp>& lamps) {
    const Balls balls = sparse_balls(lamps, glm::vec3(0.1f), 0.02f);
    const LitSurface surface(balls.drawn(), 1);
    const TrialLamp clipped = balls.tried(surface, lamps[1].place_m);
    MeasuredLight measured = first_lamp(balls, 0.2f);
    measured.usual = glm::vec3(0.5f);
    return fit_unmeasured_lamps(surface, measured, std::span(&clipped, 1), {}, balls.try_lamps(surface));
}

TEST(UnmeasuredLamps, AClippedLampIsAsBrightAsWhatItLightsTells) {
    const UnmeasuredLamps told = told_of_clipped(kTwoLamps);
    EXPECT_TRUE(told.added.empty());
    ASSERT_EQ(told.clipped.size(), 1u);
    expect_second_lamp(glm::vec3(told.clipped[0].intensity), 0.05);
    EXPECT_EQ(told.clipped[0].axis, glm::dvec3(0));
}

TEST(UnmeasuredLamps, AClippedLampInACeilingShinesDownwardsAlone) {
    std::vector<Lamp> lamps = kTwoLamps;
    lamps[1].axis = glm::normalize(glm::vec3(-0.3f, 1, 0.1f));
    const UnmeasuredLamps told = told_of_clipped(lamps);
    EXPECT_TRUE(told.added.empty());
    ASSERT_EQ(told.clipped.size(), 1u);
    expect_second_lamp(glm::vec3(told.clipped[0].intensity), 0.05);
    EXPECT_GT(glm::dot(glm::vec3(told.clipped[0].axis), lamps[1].axis), 0.98f);
    EXPECT_EQ(glm::vec3(told.clipped[0].position_m), lamps[1].place_m);
}

TEST(UnmeasuredLamps, OneThatNoPictureShowsIsBelievedWhenItIsFoundAgainOrMostIsKnown) {
    const Balls balls = sparse_balls(kTwoLamps, glm::vec3(0), 0.02f);
    const LitSurface surface(balls.drawn(), 1);
    const glm::vec3 elsewhere_m = kTwoLamps[1].place_m + glm::vec3(0, 0, 1);
    const auto told_where = [&](float unknown) {
        return fit_unmeasured_lamps(surface, first_lamp(balls, unknown), {}, std::span(&elsewhere_m, 1),
                                    balls.try_lamps(surface));
    };
    EXPECT_EQ(told_where(0.3f).added.size(), 1u) << "most of what is around is known";
    const UnmeasuredLamps told = told_where(0.4f);
    EXPECT_TRUE(told.added.empty());
    ASSERT_EQ(told.places_m.size(), 1u);
    EXPECT_LT(glm::distance(told.places_m[0], kTwoLamps[1].place_m), 0.15f);
}

TEST(UnmeasuredLamps, NoMoreAreSearchedForThanThereIsRoomFor) {
    const Balls balls = sparse_balls(kTwoLamps, glm::vec3(0), 0.02f);
    const LitSurface surface(balls.drawn(), 1);
    const UnmeasuredLamps told = fit_unmeasured_lamps(surface, first_lamp(balls, 0.1f), {}, std::span(&kBefore_m, 1),
                                                      balls.try_lamps(surface), 0);
    EXPECT_TRUE(told.places_m.empty());
    EXPECT_TRUE(told.added.empty());
}

TEST(UnmeasuredLamps, WhatIsExplainedNeedsNone) {
    const Balls balls = sparse_balls({kTwoLamps[0]}, glm::vec3(0), 0.02f);
    const LitSurface surface(balls.drawn(), 1);
    const UnmeasuredLamps told =
        fit_unmeasured_lamps(surface, first_lamp(balls, 0.1f), {}, std::span(&kBefore_m, 1), balls.try_lamps(surface));
    EXPECT_TRUE(told.places_m.empty());
}

TEST(UnmeasuredLamps, NothingIsToldWhereSurfaceIsNotExplained) {
    const Balls balls = sparse_balls(kTwoLamps, glm::vec3(0.2f), 0.6f);
    const LitSurface surface(balls.drawn(), 1);
    const TrialLamp clipped = balls.tried(surface, kTwoLamps[1].place_m);
    const UnmeasuredLamps told =
        fit_unmeasured_lamps(surface, first_lamp(balls, 0.2f), std::span(&clipped, 1), {}, balls.try_lamps(surface));
    EXPECT_TRUE(told.clipped.empty());
    EXPECT_TRUE(told.added.empty());
    const LitSurface nothing(std::vector<gpu::LightSample>(2 * gpu::kLightSamples), 1);
    EXPECT_TRUE(
        fit_unmeasured_lamps(nothing, first_lamp(balls, 0.2f), {}, {}, balls.try_lamps(nothing)).clipped.empty());
}

// The floor is the brightest surface, with 0.33. In half as much light it would have 0.66.
TEST(UnmeasuredLamps, WhereLittleIsKnownOfTheRoomItsBrightestSurfaceIsNotDark) {
    const Balls balls = sparse_balls(kTwoLamps, glm::vec3(0), 0.02f);
    const LitSurface surface(balls.drawn(), 1);
    MeasuredLight measured = first_lamp(balls, 0.6f);
    measured.tint = {1.2f, 1, 0.8f};
    const UnmeasuredLamps told =
        fit_unmeasured_lamps(surface, measured, {}, std::span(&kBefore_m, 1), balls.try_lamps(surface));
    ASSERT_EQ(told.added.size(), 1u);
    const glm::vec3 intensity(told.added[0].intensity), truth = kTwoLamps[1].intensity;
    EXPECT_LT(intensity.g, 0.6f * truth.g);
    EXPECT_NEAR(intensity.r / intensity.g, 1.2f, 1e-3f);
    EXPECT_NEAR(intensity.b / intensity.g, 0.8f, 1e-3f);

    MeasuredLight clipped = first_lamp(balls, 0.1f);
    clipped.low_exposure = false;
    const UnmeasuredLamps without =
        fit_unmeasured_lamps(surface, clipped, {}, std::span(&kBefore_m, 1), balls.try_lamps(surface));
    ASSERT_EQ(without.added.size(), 1u);
    EXPECT_LT(without.added[0].intensity.g, 0.6 * truth.g) << "pictures clip what is around, however much they know";
}

// Then the brightest surface, the floor with a mean of 0.323, has the albedo of white.
TEST(UnmeasuredLamps, WhereHardlyAnyLightIsKnownLampsAreAsBrightAsAWhiteSurfaceAsks) {
    const Balls balls = sparse_balls(kTwoLamps, glm::vec3(0), 0.02f);
    const LitSurface surface(balls.drawn(), 1);
    MeasuredLight measured{.known = std::vector<glm::vec3>(gpu::kLightSamples, glm::vec3(1e-4f)),
                           .unknown = std::vector<float>(gpu::kLightSamples, 0.1f)};
    std::vector<TrialLamp> clipped;
    for (const Lamp& lamp : kTwoLamps) clipped.push_back(balls.tried(surface, lamp.place_m));
    for (const float white : {0.8f, 0.4f}) {
        measured.white_albedo = white;
        const UnmeasuredLamps told = fit_unmeasured_lamps(surface, measured, clipped, {}, balls.try_lamps(surface));
        ASSERT_EQ(told.clipped.size(), 2u);
        for (size_t l = 0; l < 2; ++l)
            EXPECT_NEAR(told.clipped[l].intensity.g, 0.323f / white * kTwoLamps[l].intensity.g, 0.6f)
                << l << ' ' << white;
    }
}

// Albedos of 1.3 are none: then light is missing.
TEST(UnmeasuredLamps, AFifthOfTheSurfaceAtMostIsBrighterThanPaint) {
    const Balls balls = sparse_balls(kTwoLamps, glm::vec3(0), 0.02f);
    std::vector<gpu::LightSample> drawn = balls.drawn();
    for (gpu::LightSample& sample : drawn) sample.diffuse *= 4.0f;
    const LitSurface surface(drawn, 1);
    const UnmeasuredLamps told =
        fit_unmeasured_lamps(surface, first_lamp(balls, 0.1f), {}, std::span(&kBefore_m, 1), balls.try_lamps(surface));
    ASSERT_EQ(told.added.size(), 1u);
    EXPECT_GT(told.added[0].intensity.g, 1.5 * double{kTwoLamps[1].intensity.g});
}

}  // namespace
}  // namespace patina::unmeasured_lamps_test
