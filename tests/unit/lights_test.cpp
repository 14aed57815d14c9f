#include "passes/state/lights.h"

#include <limits>

#include <gmock/gmock.h>

#include "engine/core/shader_light.h"
#include "patina/error.h"

namespace patina::lights_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const Light kLamp{{0.1, -2.5, 3}, {4, 5, 6.5}, 0.05};

TEST(Lights, ShadersTakeALampRoundedToFloat) {
    const gpu::PointLight lamp = make_point_light(kLamp);
    EXPECT_EQ(lamp.position_m, glm::vec4(0.1f, -2.5f, 3, 0.05f));
    EXPECT_EQ(lamp.intensity, glm::vec4(4, 5, 6.5f, 0));
    EXPECT_EQ(lamp.axis, glm::vec4(0, 0, 0, 1));
}

TEST(Lights, AFlatLampShinesByTheCosineToItsAxis) {
    const Light flat{{1, 2, 3}, {4, 5, 6}, 0, {0, 0.6, -0.8}};
    EXPECT_TRUE(is_flat(flat));
    EXPECT_FALSE(is_flat(kLamp));
    EXPECT_EQ(make_point_light(flat).axis, glm::vec4(0, 0.6f, -0.8f, 0));
    EXPECT_LT(glm::distance(intensity_towards(flat, {1, 3.2, 1.4}), flat.intensity), 1e-12);
    EXPECT_LT(glm::distance(intensity_towards(flat, {1, 2, 1}), 0.8 * flat.intensity), 1e-12);
    EXPECT_EQ(intensity_towards(flat, {1, 2, 4}), glm::dvec3(0)) << "behind it";
    EXPECT_EQ(intensity_towards(flat, flat.position_m), glm::dvec3(0));
    EXPECT_EQ(intensity_towards(kLamp, {1, 2, 4}), kLamp.intensity);
    EXPECT_EQ(rounded_to_float(flat).axis, glm::dvec3(0, double{0.6f}, double{-0.8f}));
    // A quarter turn about x, then a step along y.
    const Light there = moved(flat, glm::dmat4(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 9, 0, 1));
    EXPECT_LT(glm::distance(there.position_m, {1, 6, 2}), 1e-12);
    EXPECT_LT(glm::distance(there.axis, {0, 0.8, 0.6}), 1e-12);
}

TEST(Lights, ShadersTakeALampFiveKilometresAwayForASun) {
    const Light near{{0, 0, 4999}, {1, 1, 1}}, far{{0, -3000, 4000}, {1, 1, 1}};
    EXPECT_FALSE(is_sun(near));
    EXPECT_TRUE(is_sun(far));
    EXPECT_EQ(make_point_light(near).intensity.w, 0);
    EXPECT_EQ(make_point_light(far).intensity.w, 1);
}

TEST(Lights, ALampComesBackAsItWasRounded) {
    const Light rounded = rounded_to_float(kLamp);
    EXPECT_EQ(rounded.position_m, glm::dvec3(double{0.1f}, -2.5, 3));
    EXPECT_EQ(rounded.intensity, kLamp.intensity);
    EXPECT_EQ(rounded.radius_m, double{0.05f});
    EXPECT_EQ(rounded_to_float(rounded), rounded);
}

TEST(Lights, VersionsChangeWithWhatShadersSee) {
    Lights lights;
    std::vector<Light> lamps{kLamp, {{1, 0, 0}, {1, 1, 1}}};
    lights.set(lamps);
    const uint32_t version = lights.version(), position_version = lights.position_version();
    lamps[0].position_m.x += 1e-12;
    lights.set(lamps);
    EXPECT_EQ(lights.version(), version) << "less than a float can hold";
    lamps[0].intensity.r = 7;
    lights.set(lamps);
    EXPECT_EQ(lights.version(), version + 1);
    lights.set(lamps, glm::dvec3(0.5));
    EXPECT_EQ(lights.version(), version + 2);
    EXPECT_EQ(lights.position_version(), position_version) << "none has moved";
    lamps[1].radius_m = 0.1;
    lights.set(lamps, glm::dvec3(0.5));
    EXPECT_EQ(lights.version(), version + 3);
    EXPECT_EQ(lights.position_version(), position_version + 1);
    lamps[1].axis = {0, 1, 0};
    lights.set(lamps, glm::dvec3(0.5));
    EXPECT_EQ(lights.version(), version + 4);
    EXPECT_EQ(lights.position_version(), position_version + 1) << "it is where it was";
}

TEST(Lights, WhatCannotShineIsRefusedAndChangesNothing) {
    Lights lights;
    lights.set(std::vector{kLamp});
    const auto refuses = [&](const Light& light, const char* why) {
        EXPECT_THAT(
            [&] {
                lights.set(std::vector{kLamp, light});
            },
            ThrowsMessage<Error>(HasSubstr("light 1 has")))
            << why;
    };
    refuses({{0, 0, std::numeric_limits<double>::quiet_NaN()}, {1, 1, 1}}, "a place that is none");
    refuses({{0, 0, 0}, {1, -1, 1}}, "darkness");
    refuses({{0, 0, 0}, {1, 1, 1}, -0.1}, "a radius below 0");
    refuses({{0, 0, 0}, {1, 1, 1}, 0, {0, 2, 0}}, "an axis of another length");
    refuses({{0, 0, 6000}, {1, 1, 1}, 0, {0, 1, 0}}, "a sun with an axis");
    refuses({{0, 0, 0}, {1, 1, 1}, 0, {0, std::numeric_limits<double>::infinity(), 0}}, "an axis that is none");
    EXPECT_THAT([&] { lights.set(std::vector<Light>(gpu::kMaxPointLights + 1, kLamp)); },
                ThrowsMessage<Error>(HasSubstr("there are 65 lights, at most 64 can be used")));
    EXPECT_THAT([&] { lights.set({}, glm::dvec3(-1)); }, ThrowsMessage<Error>(HasSubstr("the ambient light")));
    EXPECT_EQ(lights.point_lights().size(), 1u);
}

}  // namespace
}  // namespace patina::lights_test
