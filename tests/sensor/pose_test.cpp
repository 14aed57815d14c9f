#include "sensor/pose.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>

#include "tests/sensor/sequences.h"

namespace patina::sensor {
namespace {

using namespace testing;

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

TEST(Associate, TakesTheNearestPairsFirstAndEachOnce) {
    using Partners = std::vector<std::optional<size_t>>;
    const std::vector<double> a{0.0, 1.0, 2.0};
    EXPECT_EQ(associate(a, std::vector<double>{2.25, 0.25, 1.25}, 0.5), (Partners{1, 2, 0}));
    EXPECT_EQ(associate(a, std::vector<double>{0.75}, 0.5), (Partners{std::nullopt, 0, std::nullopt}));
    EXPECT_EQ(associate(a, std::vector<double>{0.5, 0.75}, 0.5),
              (Partners{0, 1, std::nullopt}));  // the limit counts as within
    EXPECT_EQ(associate(std::vector<double>{0.0, 0.25, 0.5}, std::vector<double>{0.25}, 0.5),
              (Partners{std::nullopt, 0, std::nullopt}));
    EXPECT_EQ(associate(a, {}, 0.5), (Partners(3)));
    EXPECT_EQ(associate({}, a, 0.5), Partners{});
}

}  // namespace
}  // namespace patina::sensor
