#include "tools/eval/lights.h"

#include <limits>
#include <vector>

#include <gmock/gmock.h>

namespace patina::eval::lights_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kRadius_m = 0.5;

const std::vector<Light> kTruth = {{{0, -2, 0}, {1, 2, 3}}, {{3, -2, 0}, {4, 4, 4}}, {{0, -2, 3}, {2, 1, 0.5}}};

TEST(Lights, TheTrueOnesInAnotherOrderAllMatch) {
    const std::vector<Light> run = {kTruth[2], kTruth[0], kTruth[1]};
    const LightErrors errors = compare_lights(kTruth, run, kRadius_m);
    ASSERT_EQ(errors.matches.size(), 3u);
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(errors.matches[i].truth, i);
        EXPECT_EQ(errors.matches[i].run, (i + 1) % 3);
        EXPECT_EQ(errors.matches[i].position_error_m, 0);
        EXPECT_EQ(errors.matches[i].intensity_error, glm::dvec3(0));
    }
    EXPECT_EQ(errors.common_factor, 1);
    EXPECT_THAT(errors.missed, IsEmpty());
    EXPECT_THAT(errors.invented, IsEmpty());
}

TEST(Lights, MovedOnesMatchWithinTheRadius) {
    std::vector<Light> run = kTruth;
    run[0].position_m.x += 0.3;
    run[1].position_m.z -= 0.6;
    const LightErrors errors = compare_lights(kTruth, run, kRadius_m);
    ASSERT_EQ(errors.matches.size(), 2u);
    EXPECT_NEAR(errors.matches[0].position_error_m, 0.3, 1e-12);
    EXPECT_THAT(errors.missed, ElementsAre(1));
    EXPECT_THAT(errors.invented, ElementsAre(1));
}

TEST(Lights, MissingAndInventedOnesAreListed) {
    const std::vector<Light> run = {{{9, 9, 9}, {1, 1, 1}}, kTruth[1], {{-9, 9, 9}, {1, 1, 1}}};
    const LightErrors errors = compare_lights(kTruth, run, kRadius_m);
    EXPECT_EQ(errors.matches.size(), 1u);
    EXPECT_THAT(errors.missed, ElementsAre(0, 2));
    EXPECT_THAT(errors.invented, ElementsAre(0, 2));
    EXPECT_THAT(compare_lights(kTruth, {}, kRadius_m).missed, ElementsAre(0, 1, 2));
    EXPECT_THAT(compare_lights({}, run, kRadius_m).invented, ElementsAre(0, 1, 2));
}

TEST(Lights, TheNearestPairWins) {
    const std::vector<Light> truth = {{{0, 0, 0}, {1, 1, 1}}, {{0.4, 0, 0}, {1, 1, 1}}};
    const std::vector<Light> run = {{{0.3, 0, 0}, {1, 1, 1}}};
    const LightErrors errors = compare_lights(truth, run, kRadius_m);
    ASSERT_EQ(errors.matches.size(), 1u);
    EXPECT_EQ(errors.matches[0].truth, 1u);
    EXPECT_THAT(errors.missed, ElementsAre(0));
}

TEST(Lights, ACommonFactorIsFoundAndRemoved) {
    std::vector<Light> run = kTruth;
    for (Light& light : run) light.intensity *= 1.6;
    const LightErrors errors = compare_lights(kTruth, run, kRadius_m);
    EXPECT_NEAR(errors.common_factor, 1.6, 1e-12);
    for (const LightMatch& match : errors.matches) {
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(match.intensity_error[i], 0.6, 1e-12);
            EXPECT_NEAR(match.intensity_error_after_factor[i], 0, 1e-12);
        }
    }
}

TEST(Lights, TheFactorIsTheGeometricMean) {
    std::vector<Light> run = kTruth;
    run[0].intensity *= 8;
    const LightErrors errors = compare_lights(kTruth, run, kRadius_m);
    EXPECT_NEAR(errors.common_factor, 2, 1e-12);
    EXPECT_NEAR(errors.matches[0].intensity_error_after_factor.x, 3, 1e-12);
    EXPECT_NEAR(errors.matches[1].intensity_error_after_factor.x, 0.5, 1e-12);
}

TEST(Lights, ChannelsWithoutLightDoNotDisturb) {
    const std::vector<Light> truth = {{{0, 0, 0}, {1, 0, 0}}}, run = {{{0, 0, 0}, {2, 0, 0.1}}};
    const LightErrors errors = compare_lights(truth, run, kRadius_m);
    EXPECT_NEAR(errors.common_factor, 2, 1e-12);
    EXPECT_EQ(errors.matches[0].intensity_error, glm::dvec3(1, 0, std::numeric_limits<double>::infinity()));
}

}  // namespace
}  // namespace patina::eval::lights_test
