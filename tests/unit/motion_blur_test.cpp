#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "passes/observation/observation_params.h"

namespace patina {
namespace {

const Intrinsics kCamera{{640, 480}, 500, 500, 319.5, 239.5, {}};

RigidTransform turned_about_z(double degrees) {
    return glm::rotate(RigidTransform(1.0), glm::radians(degrees), glm::dvec3(0, 0, 1));
}

TEST(MotionBlur, ARestingCameraBlursNothing) {
    const RigidTransform pose = turned_about_z(40);
    EXPECT_NEAR(motion_blur_px(kCamera, pose, pose, 2, 1), 0, 1e-9);
}

TEST(MotionBlur, SidewaysMotionIsAsFocalLengthOverDepthTimesTheShareOfTheShutter) {
    const RigidTransform before(1.0), now = glm::translate(RigidTransform(1.0), glm::dvec3(0.02, 0, 0));
    EXPECT_NEAR(motion_blur_px(kCamera, before, now, 2, 1), 500 * 0.02 / 2, 1e-9);
    EXPECT_NEAR(motion_blur_px(kCamera, before, now, 4, 0.5), 500 * 0.02 / 4 / 2, 1e-9);
}

TEST(MotionBlur, RotationAboutTheAxisBlursTheCornersMost) {
    const double chord = 2 * std::sin(glm::radians(1.0) / 2);
    EXPECT_NEAR(motion_blur_px(kCamera, turned_about_z(10), turned_about_z(11), 1, 1), chord * std::hypot(320, 240),
                1e-6);
}

TEST(MotionBlur, WhatWasBehindTheCameraIsBlurredWithoutBound) {
    const RigidTransform before = glm::rotate(RigidTransform(1.0), glm::radians(120.0), glm::dvec3(0, 1, 0));
    EXPECT_TRUE(std::isinf(motion_blur_px(kCamera, before, RigidTransform(1.0), 1, 1)));
}

}  // namespace
}  // namespace patina
