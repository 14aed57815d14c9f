#include "patina/camera.h"

#include <limits>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace patina::camera_test {
namespace {

TEST(Camera, ProjectsTheOpticalAxisToThePrincipalPoint) {
    const Intrinsics camera{{640, 480}, 500, 510, 320.5, 240.25, {0.1, -0.2, 0.01, 0.02, 0.3}};
    const glm::dvec2 pixel = project(camera, {0, 0, 3});
    EXPECT_DOUBLE_EQ(pixel.x, 320.5);
    EXPECT_DOUBLE_EQ(pixel.y, 240.25);
}

TEST(Camera, DistortionFollowsOpenCvsCoefficientOrder) {
    // One coefficient at a time at (0.5, 0.25), r2 = 0.3125: values worked by hand from OpenCV's published formula.
    const auto at = [](std::array<double, 5> k) { return distort({{1, 1}, 1, 1, 0, 0, k}, {0.5, 0.25}); };
    EXPECT_NEAR(at({1, 0, 0, 0, 0}).x, 0.5 * 1.3125, 1e-12);
    EXPECT_NEAR(at({0, 1, 0, 0, 0}).y, 0.25 * 1.09765625, 1e-12);
    EXPECT_NEAR(at({0, 0, 1, 0, 0}).x, 0.5 + 2 * 0.125, 1e-12);
    EXPECT_NEAR(at({0, 0, 1, 0, 0}).y, 0.25 + 0.3125 + 2 * 0.0625, 1e-12);
    EXPECT_NEAR(at({0, 0, 0, 1, 0}).x, 0.5 + 0.3125 + 2 * 0.25, 1e-12);
    EXPECT_NEAR(at({0, 0, 0, 0, 1}).x, 0.5 * 1.030517578125, 1e-12);
}

TEST(Camera, ScalingKeepsTheImageBorderInPlace) {
    const Intrinsics camera{{640, 480}, 500, 500, 319.5, 239.5, {}};
    const Intrinsics half = scaled_to(camera, {320, 240});
    EXPECT_DOUBLE_EQ(half.cx, 159.5);
    EXPECT_DOUBLE_EQ(half.cy, 119.5);
    EXPECT_DOUBLE_EQ(half.fx, 250);
}

TEST(RigidTransform, InverseTimesTransformIsIdentity) {
    RigidTransform transform = glm::rotate(glm::dmat4(1), 0.7, glm::normalize(glm::dvec3(1, 2, 3)));
    transform[3] = {4, -5, 6, 1};
    const RigidTransform product = rigid_inverse(transform) * transform;
    for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 4; ++r) EXPECT_NEAR(product[c][r], c == r ? 1 : 0, 1e-12);
    }
}

TEST(RigidTransform, OrthonormalisingRemovesSmallDefects) {
    RigidTransform transform = glm::rotate(glm::dmat4(1), 0.7, glm::dvec3(0, 0, 1));
    transform[0][0] += 5e-3;
    transform[1][2] -= 3e-3;
    EXPECT_GT(rotation_defect(transform), 1e-3);
    EXPECT_LT(rotation_defect(orthonormalised(transform)), 1e-12);
}

TEST(RigidTransform, DefectTellsReflectionsAndNonFiniteEntries) {
    RigidTransform mirrored(1.0);
    mirrored[0][0] = -1;
    EXPECT_GE(rotation_defect(mirrored), 2);
    RigidTransform broken(1.0);
    broken[3][1] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(rotation_defect(broken), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace patina::camera_test
