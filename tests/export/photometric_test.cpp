#include "export/photometric.h"

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

namespace patina::photometric_test {
namespace {

Patch level_patch(glm::vec3 center_m, float area_m2) { return {center_m, {0, area_m2, 0}, 0}; }

TEST(Photometric, AWhiteSurfaceBelowALampGets500Lux) {
    // 4 cd at 2 m are 1 lx, so 500 times as many are needed.
    const std::vector<Light> lights{{{0, 2, 0}, glm::dvec3(4), 0.05}};
    const std::vector<Patch> patches{level_patch({0, 0, 0}, 0.01f)};
    EXPECT_NEAR(candela_per_intensity(lights, patches), 500, 1e-3);
}

TEST(Photometric, AFlatLampCountsByTheCosineToItsAxis) {
    const std::vector<Light> slanted{{{0, 2, 0}, glm::dvec3(4), 0, {0, -0.8, 0.6}}};
    EXPECT_NEAR(candela_per_intensity(slanted, std::vector<Patch>{level_patch({0, 0, 0}, 0.01f)}), 500 / 0.8, 1e-3);
}

TEST(Photometric, TheMeanIsOverTheAreaOfAllLampsByLuminance) {
    const std::vector<Light> lights{{{0, 1, 0}, {1, 0, 0}, 0}, {{0, 1, 0}, {0, 1, 1}, 0}};
    const std::vector<Patch> lit_and_turned_away{level_patch({0, 0, 0}, 1), level_patch({0, 2, 0}, 3)};
    EXPECT_NEAR(candela_per_intensity(lights, lit_and_turned_away), 500.0 * 4, 0.01);
    const std::vector<Patch> slanted{level_patch({1, 0, 0}, 1)};  // at 45 degrees, and at the root of 2
    EXPECT_NEAR(candela_per_intensity(lights, slanted), 500.0 * 2 * std::sqrt(2.0), 0.01);
}

TEST(Photometric, SurfaceInALampCountsAsBesideIt) {
    const std::vector<Light> lights{{{0, 1e-6, 0}, glm::dvec3(1), 0.2}};
    EXPECT_GE(candela_per_intensity(lights, std::vector<Patch>{level_patch({0, 0, 0}, 1)}), 500 * 0.2 * 0.2);
}

TEST(Photometric, AWhiteSurfaceUnderAnEnvironmentGets500Lux) {
    EXPECT_NEAR(luminance_per_pixel_value(Image<glm::vec3>({64, 32}, glm::vec3(2))), 500 / (2 * glm::pi<double>()),
                1e-3);
    Image<glm::vec3> upper({64, 32}, glm::vec3(0));
    for (uint32_t y = 0; y < 16; ++y)
        for (uint32_t x = 0; x < 64; ++x) upper.at(x, y) = glm::vec3(2);
    EXPECT_NEAR(luminance_per_pixel_value(upper), 500 / glm::pi<double>(), 1e-3) << "half of what it may face";
}

TEST(Photometric, WithoutLightTheFactorIs1) {
    const std::vector<Patch> patches{level_patch({0, 0, 0}, 1)};
    EXPECT_EQ(candela_per_intensity({}, patches), 1);
    EXPECT_EQ(candela_per_intensity(std::vector<Light>{{{0, -1, 0}, glm::dvec3(1), 0}}, patches), 1);
    EXPECT_EQ(candela_per_intensity(std::vector<Light>{{{0, 1, 0}, glm::dvec3(1), 0}}, {}), 1);
}

}  // namespace
}  // namespace patina::photometric_test
