#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "tests/reference/ward.h"

namespace patina::reference {
namespace {

constexpr glm::dvec3 kNormal(0, 0, 1);

glm::dvec3 direction(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// The share of the light from one direction that leaves into the hemisphere, or, as the BRDF is reciprocal, of a
/// uniform sky's that leaves towards the viewer: the integral of the BRDF times the cosine.
double albedo(const Ward& material, double theta_viewer) {
    constexpr int kThetaSteps = 2000, kPhiSteps = 360;
    constexpr double kThetaStep = std::numbers::pi / 2 / kThetaSteps, kPhiStep = 2 * std::numbers::pi / kPhiSteps;
    double sum = 0;
    for (int i = 0; i < kThetaSteps; ++i) {
        const double theta = (i + 0.5) * kThetaStep;
        for (int j = 0; j < kPhiSteps; ++j) {
            const glm::dvec3 to_light = direction(theta, (j + 0.5) * kPhiStep);
            sum += ward(material, kNormal, to_light, direction(theta_viewer, 0)).g * std::cos(theta) * std::sin(theta) *
                   kThetaStep * kPhiStep;
        }
    }
    return sum;
}

TEST(WardReference, IsReciprocal) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> theta(0, std::numbers::pi / 2), phi(0, 2 * std::numbers::pi);
    for (const double alpha : {0.05, 0.2, 1.0}) {
        const Ward material{{0.1, 0.2, 0.3}, {0.3, 0.2, 0.1}, alpha};
        for (int i = 0; i < 100; ++i) {
            const glm::dvec3 a = direction(theta(random), phi(random)), b = direction(theta(random), phi(random));
            const glm::dvec3 forth = ward(material, kNormal, a, b), back = ward(material, kNormal, b, a);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(forth[c], back[c], 1e-12 * forth[c]);
        }
    }
}

TEST(WardReference, DiffuseAlbedoIsKd) { EXPECT_NEAR(albedo({glm::dvec3(0.6), glm::dvec3(0), 0.2}, 0.7), 0.6, 1e-5); }

// For small alpha, tan(theta_h)^2 is (theta_i / 2)^2 and the cosines are 1; what that neglects grows with alpha^2.
TEST(WardReference, SpecularAlbedoNearNormalIncidenceIsKs) {
    EXPECT_NEAR(albedo({glm::dvec3(0), glm::dvec3(0.5), 0.05}, 0.0), 0.5, 0.5 * 0.01);
    EXPECT_NEAR(albedo({glm::dvec3(0), glm::dvec3(0.5), 0.1}, 0.1), 0.5, 0.5 * 0.04);
}

TEST(WardReference, MirrorDirectionHasThePeakOfEquation2) {
    const double theta = 0.5, alpha = 0.1;
    const double peak = 0.3 / (4 * std::numbers::pi * alpha * alpha * std::cos(theta));
    const glm::dvec3 got =
        ward({glm::dvec3(0), glm::dvec3(0.3), alpha}, kNormal, direction(theta, 0), direction(theta, std::numbers::pi));
    EXPECT_NEAR(got.r, peak, 1e-9 * peak);
}

TEST(WardReference, IsZeroAtAndBelowTheHorizon) {
    const Ward material{glm::dvec3(1), glm::dvec3(1), 0.5};
    for (const double theta : {std::numbers::pi / 2 + 1e-9, 2.0, 3.0}) {
        EXPECT_EQ(ward(material, kNormal, direction(theta, 0), kNormal), glm::dvec3(0));
        EXPECT_EQ(ward(material, kNormal, kNormal, direction(theta, 0)), glm::dvec3(0));
    }
}

}  // namespace
}  // namespace patina::reference
