#include "sensor/pose_convention.h"

#include <array>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>

#include "sensor/files/picture_file.h"
#include "sensor/inspect.h"
#include "tests/sensor/sequences.h"

namespace patina::sensor::pose_convention_test {
namespace {

using namespace testing;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr Extent2D kExtent{64, 48};

/// How far a ray from inside a room of 4 x 3 x 5 m goes, with a ball in it.
double distance_m(glm::dvec3 from, glm::dvec3 direction) {
    const glm::dvec3 half(2, 1.5, 2.5);
    double nearest = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
        const double wall = direction[axis] > 0 ? half[axis] : -half[axis];
        if (direction[axis] != 0) nearest = std::min(nearest, (wall - from[axis]) / direction[axis]);
    }
    const glm::dvec3 center(0.4, 0.3, 1.2);
    const double b = glm::dot(direction, center - from), c = glm::dot(center - from, center - from) - 0.25;
    const double along = glm::dot(direction, direction);
    const double root = b * b - along * c;
    return root > 0 ? std::min(nearest, (b - std::sqrt(root)) / along) : nearest;
}

SequenceInfo room_info() {
    SequenceInfo info = test_info();
    info.depth = test_camera(kExtent);
    info.has_poses = true;
    info.frames = 12;
    return info;
}

/// Frames of a camera that turns and moves in that room; what `told` makes of the poses is recorded.
std::vector<Reading> room(const std::function<RigidTransform(const RigidTransform&)>& told) {
    const SequenceInfo info = room_info();
    std::vector<Reading> readings;
    for (uint32_t i = 0; i < info.frames; ++i) {
        RigidTransform pose = glm::translate(RigidTransform(1), glm::dvec3(0.5 - 0.08 * i, 0.2 - 0.05 * i, -0.1 * i));
        pose = glm::rotate(pose, 0.5 + 0.06 * i, glm::dvec3(0.2, 1, 0.1));
        Frame frame = test_frame(i, {32, 24}, kExtent);
        Image<float> depth(kExtent);
        for (uint32_t y = 0; y < kExtent.height; ++y) {
            for (uint32_t x = 0; x < kExtent.width; ++x) {
                const glm::dvec3 ray((x - info.depth.cx) / info.depth.fx, (y - info.depth.cy) / info.depth.fy, 1);
                depth.at(x, y) =
                    static_cast<float>(distance_m(glm::dvec3(pose[3]), glm::dvec3(glm::dmat3(pose) * ray)));
            }
        }
        frame.depth = std::move(depth);
        frame.world_from_camera = told(pose);
        readings.push_back(std::move(frame));
    }
    return readings;
}

std::vector<std::string> warnings_of(const std::function<RigidTransform(const RigidTransform&)>& told) {
    MemorySource source(room_info(), room(told));
    return inspect(source).warnings;
}

RigidTransform flip(double x, double y, double z) { return glm::scale(RigidTransform(1), glm::dvec3(x, y, z)); }

TEST(PoseConvention, RightPosesAreNotDoubted) {
    EXPECT_THAT(warnings_of([](const RigidTransform& pose) { return pose; }), ::testing::IsEmpty());
    // Another world does not matter.
    const RigidTransform world = glm::rotate(RigidTransform(1), 2.0, glm::dvec3(1, 2, 3));
    EXPECT_THAT(warnings_of([&](const RigidTransform& pose) { return world * pose; }), ::testing::IsEmpty());
}

TEST(PoseConvention, OtherConventionsAreNamed) {
    EXPECT_THAT(warnings_of([](const RigidTransform& pose) { return rigid_inverse(pose); }),
                Contains(HasSubstr("the poses look inverted (world-to-camera): then")));
    EXPECT_THAT(warnings_of([](const RigidTransform& pose) { return pose * flip(1, -1, -1); }),
                Contains(HasSubstr("y axis points up and z axis backward (as in OpenGL)")));
    EXPECT_THAT(warnings_of([](const RigidTransform& pose) { return flip(1, -1, -1) * rigid_inverse(pose); }),
                Contains(HasSubstr("inverted (world-to-camera), and like those of a camera whose y axis points up")));
    EXPECT_THAT(warnings_of([](const RigidTransform& pose) { return flip(1, -1, 1) * pose * flip(1, -1, 1); }),
                Contains(HasSubstr("a left-handed world, its y axis mirrored")));
    EXPECT_THAT(warnings_of([](const RigidTransform& pose) { return flip(-1, 1, 1) * pose * flip(-1, 1, 1); }),
                Contains(HasSubstr("a left-handed world, its x axis mirrored")));
}

TEST(PoseConvention, IsLeftAloneWherePosesGoUnused) {
    const auto warnings = [](ConventionCheck check) {
        Inspector inspector(room_info(), check);
        for (const Reading& reading : room([](const RigidTransform& pose) { return rigid_inverse(pose); }))
            inspector.add(reading);
        return inspector.report().warnings;
    };
    EXPECT_THAT(warnings(ConventionCheck::kOn), Contains(HasSubstr("the poses look inverted")));
    EXPECT_THAT(warnings(ConventionCheck::kOff), ::testing::Not(Contains(HasSubstr("the poses look"))));
}

TEST(PoseConvention, AWorldFarFromItsOriginIsToldOf) {
    EXPECT_THAT(warnings_of([](const RigidTransform& pose) {
                    return glm::translate(RigidTransform(1), glm::dvec3(3e6, 0, 4e6)) * pose;
                }),
                Contains(HasSubstr("the first camera is 5000.0 km from the world's origin")));
}

}  // namespace
}  // namespace patina::sensor::pose_convention_test
