#include "reconstruction/lights/split_environment.h"

#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "shared/reflectance/far_field.h"

namespace patina::split_environment_test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr Extent2D kExtent{256, 128};

/// glTF's axes: the picture's middle is +x, its right half +z.
glm::dvec3 direction_of(double x, double y) {
    const double turn = 2 * kPi * (x / kExtent.width - 0.5), tilt = kPi * (0.5 - y / kExtent.height);
    return {std::cos(tilt) * std::cos(turn), std::sin(tilt), std::cos(tilt) * std::sin(turn)};
}

template <typename Radiance>
Image<glm::vec3> drawn(const Radiance& radiance) {
    Image<glm::vec3> picture(kExtent);
    for (uint32_t y = 0; y < kExtent.height; ++y) {
        for (uint32_t x = 0; x < kExtent.width; ++x)
            picture.at(x, y) = glm::vec3(glm::dvec3(radiance(direction_of(x + 0.5, y + 0.5))));
    }
    return picture;
}

glm::dvec3 irradiance_of(const Image<glm::vec3>& picture, glm::dvec3 normal) {
    glm::dvec3 sum(0);
    for (uint32_t y = 0; y < kExtent.height; ++y) {
        const double sr =
            2 * kPi / kExtent.width * kPi / kExtent.height * std::cos(kPi * (0.5 - (y + 0.5) / kExtent.height));
        for (uint32_t x = 0; x < kExtent.width; ++x)
            sum += glm::dvec3(picture.at(x, y)) * sr * std::max(glm::dot(normal, direction_of(x + 0.5, y + 0.5)), 0.0);
    }
    return sum;
}

/// Of texel centres, in the world.
glm::dvec3 direction_of_texel(uint32_t texel) {
    const glm::dvec2 p = (glm::dvec2(texel % 32, texel / 32) + 0.5) / 16.0 - 1.0;
    const double z = 1 - std::abs(p.x) - std::abs(p.y);
    glm::dvec3 d(p, z);
    if (z < 0) d = {(1 - std::abs(p.y)) * (p.x < 0 ? -1 : 1), (1 - std::abs(p.x)) * (p.y < 0 ? -1 : 1), z};
    return glm::normalize(d);
}

/// What a surface receives of a split environment. An octahedral texel's solid angle is its square's over |p|_1's norm
/// cubed: d = 4 / 32^2 / |v|^3 with v on the octahedron.
glm::dvec3 irradiance_of(const SplitEnvironment& split, glm::dvec3 normal) {
    glm::dvec3 sum(0);
    for (uint32_t texel = 0; texel < gpu::kFarFieldTexels; ++texel) {
        const glm::dvec3 d = direction_of_texel(texel);
        const double on_octahedron = 1 / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
        const double sr = 4.0 / gpu::kFarFieldTexels / std::pow(on_octahedron, 3);
        sum += glm::dvec3(split.far_field[texel]) * sr * std::max(glm::dot(d, normal), 0.0);
    }
    for (const Light& lamp : split.lamps) {
        const double distance = glm::length(lamp.position_m);
        sum += lamp.intensity / (distance * distance) * std::max(glm::dot(lamp.position_m, normal) / distance, 0.0);
    }
    return sum;
}

/// A dim room with a sun, and a window 40 degrees wide and high.
glm::dvec3 sun_and_window(glm::dvec3 d) {
    if (glm::dot(d, glm::normalize(glm::dvec3(1, 2, -1))) > std::cos(0.04)) return {400, 380, 300};
    if (std::abs(std::atan2(d.x, d.z)) < 0.35 && std::abs(d.y) < 0.34) return {6, 7, 9};
    return {0.2, 0.15, 0.1};
}

TEST(SplitEnvironment, AnEvenSkyIsAllFarField) {
    const SplitEnvironment split = split_environment(Image<glm::vec3>({64, 32}, glm::vec3(2, 1, 0.5f)), glm::dmat3(1));
    EXPECT_TRUE(split.lamps.empty());
    ASSERT_EQ(split.far_field.size(), gpu::kFarFieldTexels);
    for (const glm::vec3& radiance : split.far_field)
        EXPECT_NEAR(glm::distance(radiance, glm::vec3(2, 1, 0.5f)), 0, 1e-5);
}

TEST(SplitEnvironment, AllLightArrivesAsBefore) {
    const Image<glm::vec3> picture = drawn(sun_and_window);
    const SplitEnvironment split = split_environment(picture, glm::dmat3(1));
    EXPECT_GT(split.lamps.size(), 3u) << "the window is wide";
    EXPECT_LE(split.lamps.size(), kMostEnvironmentLamps);
    for (const glm::dvec3 normal :
         {glm::dvec3(0, 1, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(0.6, 0, 0.8)}) {
        const glm::dvec3 expected = irradiance_of(picture, normal), got = irradiance_of(split, normal);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c] / expected[c], 1, 0.03) << normal.x << normal.y << normal.z;
    }
}

TEST(SplitEnvironment, ThereAreNoMoreLampsThanAskedFor) {
    const Image<glm::vec3> picture = drawn(sun_and_window);
    EXPECT_LE(split_environment(picture, glm::dmat3(1), 3).lamps.size(), 3u);
    const SplitEnvironment none = split_environment(picture, glm::dmat3(1), 0);
    EXPECT_TRUE(none.lamps.empty());
    const double expected = irradiance_of(picture, {0, 0, 1}).g;
    EXPECT_NEAR(irradiance_of(none, {0, 0, 1}).g / expected, 1, 0.05) << "no light is lost";
}

TEST(SplitEnvironment, ASunIsOneLampWhereItStandsInTheWorld) {
    const glm::dvec3 towards = glm::normalize(glm::dvec3(-1, 1.5, 2));
    const Image<glm::vec3> picture =
        drawn([&](glm::dvec3 d) { return glm::dvec3(glm::dot(d, towards) > std::cos(0.03) ? 500 : 0.1); });
    const glm::dmat3 turned(glm::rotate(glm::dmat4(1), 0.7, glm::dvec3(0.3, 0.9, -0.2)));
    const SplitEnvironment split = split_environment(picture, turned);
    ASSERT_EQ(split.lamps.size(), 1u);
    EXPECT_GT(glm::dot(glm::normalize(turned * split.lamps[0].position_m), towards), std::cos(0.01));
    EXPECT_NEAR(glm::length(split.lamps[0].position_m), kEnvironmentDistance_m, 1);
    for (uint32_t texel = 0; texel < gpu::kFarFieldTexels; ++texel) EXPECT_LT(split.far_field[texel].r, 3);
}

TEST(SplitEnvironment, TexelsAreThoseOfTheirDirections) {
    const Image<glm::vec3> picture = drawn([](glm::dvec3 d) { return glm::dvec3(1) + d; });
    const glm::dmat3 turned(glm::rotate(glm::dmat4(1), 1.1, glm::dvec3(0, 1, 0)));
    const SplitEnvironment split = split_environment(picture, turned);
    for (uint32_t texel = 0; texel < gpu::kFarFieldTexels; ++texel) {
        const glm::dvec3 expected = glm::dvec3(1) + turned * direction_of_texel(texel);
        EXPECT_LT(glm::distance(glm::dvec3(split.far_field[texel]), expected), 0.05);
    }
}

TEST(SplitEnvironment, FinePicturesAreAveraged) {
    Image<glm::vec3> fine({4096, 2048});
    for (uint32_t y = 0; y < 2048; ++y) {
        for (uint32_t x = 0; x < 4096; ++x) fine.at(x, y) = glm::vec3((x + y) % 2 == 0 ? 1.0f : 3.0f);
    }
    for (const glm::vec3& radiance : split_environment(fine, glm::dmat3(1)).far_field) EXPECT_NEAR(radiance.g, 2, 1e-4);
}

TEST(SplitEnvironment, NothingIsRefused) { EXPECT_THROW(split_environment({}, glm::dmat3(1)), Error); }

}  // namespace
}  // namespace patina::split_environment_test
