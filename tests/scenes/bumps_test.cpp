#include "scenes/description/bumps.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "scenes/description/mesh.h"

namespace patina::scenes::bumps_test {
namespace {

constexpr double kRadius_m = 0.5;

/// An octahedron divided onto a sphere.
TriangleMesh sphere() {
    TriangleMesh mesh;
    constexpr int kSteps = 12;
    const auto add = [&](glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
        const auto point = [&](int i, int j) {
            const glm::dvec3 p = a + (b - a) * (double(i) / kSteps) + (c - a) * (double(j) / kSteps);
            return glm::vec3(kRadius_m * glm::normalize(p));
        };
        const auto triangle = [&](glm::vec3 x, glm::vec3 y, glm::vec3 z) {
            const auto first = static_cast<uint32_t>(mesh.positions_m.size());
            mesh.positions_m.insert(mesh.positions_m.end(), {x, y, z});
            mesh.triangles.emplace_back(first, first + 1, first + 2);
        };
        for (int i = 0; i < kSteps; ++i) {
            for (int j = 0; i + j < kSteps; ++j) {
                triangle(point(i, j), point(i + 1, j), point(i, j + 1));
                if (i + j + 1 < kSteps) triangle(point(i + 1, j), point(i + 1, j + 1), point(i, j + 1));
            }
        }
    };
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0})
            for (const double z : {-1.0, 1.0}) {
                const bool turned = x * y * z < 0;
                add({x, 0, 0}, turned ? glm::dvec3(0, 0, z) : glm::dvec3(0, y, 0),
                    turned ? glm::dvec3(0, y, 0) : glm::dvec3(0, 0, z));
            }
    return joined(mesh);
}

/// The sphere divided as with_bumps() does it, without any.
TriangleMesh smooth() { return with_bumps(sphere(), {1e-9, 0.1, 1}); }

TEST(Bumps, LieWithinTheirDepthAndUseMostOfIt) {
    const TriangleMesh bumpy = with_bumps(sphere(), {0.01, 0.1, 1}), plain = smooth();
    ASSERT_EQ(bumpy.positions_m.size(), plain.positions_m.size());
    double low_m = 0, high_m = 0, mean_m = 0;
    for (size_t i = 0; i < plain.positions_m.size(); ++i) {
        const glm::dvec3 moved_m(bumpy.positions_m[i] - plain.positions_m[i]);
        const double out_m = glm::dot(moved_m, glm::dvec3(plain.normals[i]));
        EXPECT_LT(glm::length(moved_m - out_m * glm::dvec3(plain.normals[i])), 1e-6) << "along the normal";
        low_m = std::min(low_m, out_m);
        high_m = std::max(high_m, out_m);
        mean_m += out_m / static_cast<double>(plain.positions_m.size());
    }
    EXPECT_GE(low_m, -0.005 - 1e-6);
    EXPECT_LE(high_m, 0.005 + 1e-6);
    EXPECT_GT(high_m - low_m, 0.006);
    EXPECT_NEAR(mean_m, 0, 0.0005);
}

TEST(Bumps, TiltNormalsAsMuchAsTheirSlopes) {
    const TriangleMesh plain = smooth();
    const auto tilt = [&](double depth_m) {
        const TriangleMesh bumpy = with_bumps(sphere(), {depth_m, 0.1, 1});
        double sum = 0;
        for (size_t i = 0; i < plain.normals.size(); ++i)
            sum += std::acos(std::min(1.0f, glm::dot(plain.normals[i], bumpy.normals[i])));
        return sum / static_cast<double>(plain.normals.size());
    };
    EXPECT_NEAR(tilt(0.01) / tilt(0.005), 2, 0.1);
    EXPECT_GT(tilt(0.01), 0.03);
    EXPECT_LT(tilt(0.01), 0.3);
}

TEST(Bumps, AreTheSameForTheSameSeed) {
    const Bumps bumps{0.01, 0.1, 7};
    EXPECT_EQ(with_bumps(sphere(), bumps).positions_m, with_bumps(sphere(), bumps).positions_m);
    EXPECT_NE(with_bumps(sphere(), bumps).positions_m, with_bumps(sphere(), {0.01, 0.1, 8}).positions_m);
}

TEST(Bumps, NeedTrianglesThatAreFineEnough) {
    EXPECT_GT(with_bumps(sphere(), {0.001, 0.04, 0}).triangles.size(), 4 * sphere().triangles.size() - 1);
    EXPECT_THROW(with_bumps(sphere(), {0.001, 0.0005, 0}), Error);
}

}  // namespace
}  // namespace patina::scenes::bumps_test
