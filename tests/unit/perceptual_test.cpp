#include "passes/specular/perceptual.h"

#include <random>

#include <gtest/gtest.h>

namespace patina::perceptual_test {
namespace {

TEST(Perceptual, LabOfKnownColorsIsKnown) {
    const Perceptual grey = perceptual_of({glm::dvec3(0.18), {}, 1});
    EXPECT_NEAR(grey[0], 0.49496, 1e-5);
    EXPECT_NEAR(grey[1], 0, 1e-5);
    EXPECT_NEAR(grey[2], 0, 1e-5);
    const Perceptual red = perceptual_of({{0.5, 0.1, 0.1}, {}, 1});
    EXPECT_NEAR(red[0], 0.50105, 1e-5);
    EXPECT_NEAR(red[1], 0.39651, 1e-5);
    EXPECT_NEAR(red[2], 0.18995, 1e-5);
    EXPECT_NEAR(perceptual_of({glm::dvec3(1), {}, 1})[0], 1, 1e-6);
    EXPECT_NEAR(perceptual_of({glm::dvec3(0), {}, 1})[0], 0, 1e-12);
}

TEST(Perceptual, GlossOfKnownMaterialsIsKnown) {
    struct Known {
        double kd, ks, alpha, c, d;
    };
    for (const Known& known : {Known{0.03, 0.033, 0.04, 0.11680, 0.96}, Known{0.193, 0.066, 0.07, 0.08702, 0.93},
                               Known{0.767, 0.099, 0.10, 0.05780, 0.90}}) {
        const Perceptual w = perceptual_of({glm::dvec3(known.kd), glm::dvec3(known.ks), known.alpha});
        for (size_t c = 3; c < 6; ++c) EXPECT_NEAR(w[c], known.c, 1e-5);
        EXPECT_NEAR(w[6], known.d, 1e-12);
    }
}

TEST(Perceptual, TheInverseReturnsToTheMaterial) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> level(0, 1);
    for (int i = 0; i < 1000; ++i) {
        const double dark = i % 2 == 0 ? 0.01 : 1;
        const auto rgb = [&](double most) { return most * glm::dvec3(level(random), level(random), level(random)); };
        const WardParameters material{rgb(dark), rgb(0.5), 0.01 + level(random)};
        const WardParameters back = ward_of(perceptual_of(material));
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(back.kd[c], material.kd[c], 1e-9);
            EXPECT_NEAR(back.ks[c], material.ks[c], 1e-9);
        }
        EXPECT_NEAR(back.alpha, material.alpha, 1e-12);
    }
}

TEST(Perceptual, WhatNoMaterialHasIsBroughtBackToOne) {
    const WardParameters white = ward_of({1.2, 0, 0, -0.1, -0.1, -0.1, 1.5});
    EXPECT_EQ(white.kd, glm::dvec3(1));
    EXPECT_EQ(white.ks, glm::dvec3(0));
    EXPECT_EQ(white.alpha, 0.01);
    const WardParameters black = ward_of({-0.1, 0.3, 0, 0.2, 0.2, 0.2, 0.5});
    for (int c = 0; c < 3; ++c) {
        EXPECT_GE(black.kd[c], 0);
        EXPECT_GE(black.ks[c], 0);
    }
}

}  // namespace
}  // namespace patina::perceptual_test
