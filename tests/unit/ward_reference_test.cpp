#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "tests/reference/scenes/sampling.h"

namespace patina::reference::ward_reference_test {
namespace {

constexpr glm::dvec3 kNormal(0, 0, 1);

double albedo(const Ward& material, double theta_viewer) { return ward_albedo(material, theta_viewer, 2000).g; }

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

// A lobe of ks = 1 never reflects more than arrives, up to 75 degrees of view: it darkens from 1 (less for rough ones,
// whose half vectors fall below the horizon) to about a quarter. Values at 0, 45 and 75 degrees, by this quadrature:
//   alpha 0.05: 0.99, 0.70, 0.26;  0.1: 0.97, 0.69, 0.26;  0.2: 0.90, 0.64, 0.27;  0.5: 0.59, 0.44, 0.28;
//   alpha 1: 0.26, 0.23, 0.21.
// Towards the horizon the root in the classic denominator lets it grow without bound instead.
TEST(WardReference, KeepsEnergyUpTo75DegreesAndGrowsWithoutBoundBeyond) {
    const auto at = [](double alpha, double degrees) {
        const Ward lobe{glm::dvec3(0), glm::dvec3(1), alpha};
        return ward_albedo(lobe, degrees * std::numbers::pi / 180, 600, 180).g;
    };
    for (const double alpha : {0.05, 0.1, 0.2, 0.5, 1.0})
        for (const double degrees : {0.0, 45.0, 75.0}) EXPECT_LT(at(alpha, degrees), 1) << alpha << ' ' << degrees;
    EXPECT_NEAR(at(0.1, 0), 0.971, 0.002);
    EXPECT_NEAR(at(0.2, 75), 0.269, 0.002);
    EXPECT_NEAR(at(1.0, 75), 0.205, 0.002);
    EXPECT_GT(at(1.0, 89.9), 1);
    // The cosine falls by 100, its root by 10.
    EXPECT_NEAR(at(1.0, 89.9999) / at(1.0, 89.99), 10, 0.1);
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
}  // namespace patina::reference::ward_reference_test
