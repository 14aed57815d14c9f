#include "export/trajectory.h"

#include <limits>
#include <sstream>

#include <glm/gtc/quaternion.hpp>
#include <gmock/gmock.h>

#include "tests/export/throws.h"

namespace patina::trajectory_test {
namespace {

using test::throws_error_with;

TimedPose pose_at(double timestamp_s, glm::dvec3 position_m, glm::dquat rotation) {
    RigidTransform transform(glm::mat4_cast(rotation));
    transform[3] = glm::dvec4(position_m, 1);
    return {timestamp_s, transform};
}

std::string line_of(const TimedPose& pose) {
    const std::string text = trajectory_text({&pose, 1});
    return text.substr(text.find('\n') + 1);
}

TEST(Trajectory, HasOneHeaderAndOneLineAPose) {
    EXPECT_EQ(trajectory_text({}), "# timestamp tx ty tz qx qy qz qw\n");
    EXPECT_EQ(line_of(pose_at(1305031102.175304, {1.5, -2, 1e-7}, {1, 0, 0, 0})),
              "1305031102.175304 1.500000 -2.000000 0.000000 0.000000000 0.000000000 0.000000000 1.000000000\n");
}

TEST(Trajectory, QuaternionIsInTheOrderXyzw) {
    EXPECT_EQ(line_of(pose_at(0, {}, {0.5, 0.5, -0.5, 0.5})),
              "0.000000 0.000000 0.000000 0.000000 0.500000000 -0.500000000 0.500000000 0.500000000\n");
}

TEST(Trajectory, EqualRotationsGiveEqualLines) {
    const glm::dquat rotation = glm::normalize(glm::dquat(0.3, -0.2, 0.8, 0.4));
    EXPECT_EQ(line_of(pose_at(0, {}, rotation)), line_of(pose_at(0, {}, -rotation)));
    // Half turns: w is zero, up to rounding of either sign.
    const glm::dquat half_turn(0, 0, -1, 0);
    EXPECT_THAT(line_of(pose_at(0, {}, half_turn)),
                testing::HasSubstr(" 0.000000000 1.000000000 0.000000000 0.000000000\n"));
    EXPECT_EQ(line_of(pose_at(0, {}, glm::normalize(glm::dquat(1e-13, 0, 1, 0)))),
              line_of(pose_at(0, {}, glm::normalize(glm::dquat(-1e-13, 0, 1, 0)))));
}

TEST(Trajectory, ReadsBackWithinItsPrecision) {
    const glm::dquat rotation = glm::normalize(glm::dquat(0.1, -0.7, 0.3, -0.2));
    const TimedPose pose = pose_at(12.345678, {0.1234564, -9.8765432, 3}, rotation);
    std::istringstream line(line_of(pose));
    double time = 0;
    glm::dvec3 position;
    glm::dquat read;
    line >> time >> position.x >> position.y >> position.z >> read.x >> read.y >> read.z >> read.w;
    ASSERT_TRUE(line);
    EXPECT_NEAR(time, 12.345678, 0.5e-6);
    EXPECT_LT(glm::distance(position, glm::dvec3(pose.world_from_camera[3])), 1e-6);
    EXPECT_GT(std::abs(glm::dot(read, rotation)), 1 - 1e-9);
    EXPECT_GE(read.w, 0);
}

TEST(Trajectory, RefusesWhatIsNoPose) {
    TimedPose nan;
    nan.world_from_camera[3].x = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT([&] { line_of(nan); }, throws_error_with("pose 0 at 0 s is not finite"));
    TimedPose late{std::numeric_limits<double>::infinity(), RigidTransform(1.0)};
    EXPECT_THAT([&] { line_of(late); }, throws_error_with("pose 0 at inf s is not finite"));
    TimedPose scaled;
    scaled.world_from_camera[0].x = 2;
    EXPECT_THAT([&] { line_of(scaled); }, throws_error_with("its defect is 3"));
}

}  // namespace
}  // namespace patina::trajectory_test
