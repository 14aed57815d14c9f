#include "sensor/pose.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>

#include "tests/sensor/sequences.h"

namespace patina::sensor::pose_test {
namespace {

using namespace testing;

TEST(Pose, AReflectionIsCalledThat) {
    RigidTransform mirror(1.0);
    mirror[0][0] = -1;
    EXPECT_THAT(error_of([&] { checked_pose(mirror, "a.txt"); }),
                ::testing::HasSubstr("a.txt: the pose mirrors what it moves"));
}

TEST(Pose, ATrajectoryReadsBackTheSamePoses) {
    const TemporaryFolder folder;
    std::vector<StampedPose> poses;
    std::vector<double> timestamps_s;
    for (int i = 0; i < 5; ++i) {
        const RigidTransform turn = glm::rotate(RigidTransform(1.0), 0.8 * i, glm::normalize(glm::dvec3(1, 2, 3)));
        poses.push_back({i / 30.0, glm::translate(RigidTransform(1.0), {0.1 * i, -i / 3.0, 1e-9}) * turn});
        timestamps_s.push_back(i / 30.0);
    }
    write_trajectory(folder / "t.txt", poses);
    const FramePoses read(folder / "t.txt", timestamps_s, 0);
    for (uint32_t i = 0; i < 5; ++i) {
        const CheckedPose pose = read.of_frame(i).value();
        for (int column = 0; column < 4; ++column) {
            EXPECT_LT(glm::distance(pose.transform[column], poses[i].world_from_camera[column]), 1e-15) << i;
        }
    }
}

}  // namespace
}  // namespace patina::sensor::pose_test
