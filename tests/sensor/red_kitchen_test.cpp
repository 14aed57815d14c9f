#include <gmock/gmock.h>

#include "sensor/inspect.h"
#include "sensor/ledger.h"
#include "sensor/open.h"
#include "sensor/prefetch.h"
#include "tests/data_folder.h"

namespace patina::sensor::red_kitchen_test {
namespace {

using ::testing::ElementsAre;

// Expected values are what the recording's own description states (300 frames, about 0.7 cm of motion a frame, 1-2 % of
// pixels saturated, about 10 % of depth missing, rotations within 5e-4), and the files that are equal byte by byte to
// the one before.
TEST(RedKitchen, IsReadWholeAndDescribedAsItIs) {
    const auto folder = patina::testing::data_folder("rgbd-redkitchen");
    if (!folder) GTEST_SKIP() << patina::testing::kNoData;
    PrefetchSource source(open_sequence(*folder));
    EXPECT_EQ(source.info().format, "7-scenes");
    EXPECT_EQ(source.info().frames, 300u);
    EXPECT_EQ(source.info().depth.extent, (Extent2D{640, 480}));
    EXPECT_EQ(source.info().color.fx, 528);

    const SequenceReport report = inspect(source);
    EXPECT_EQ(report.usable_frames, 300u);
    EXPECT_EQ(report.poses.frames, 300u);
    EXPECT_NEAR(report.poses.path_length_m / 299, 0.007, 0.003);
    EXPECT_GT(report.poses.worst_defect, 1e-5);
    EXPECT_LT(report.poses.worst_defect, 5e-4);
    EXPECT_NEAR(report.depth.valid_share, 0.9, 0.05);
    EXPECT_NEAR(report.color.clipped_share, 0.015, 0.01);
    EXPECT_THAT(report.warnings,
                ElementsAre("colour repeats the picture before in 16 of 300 frames, first in frame 228",
                            "depth repeats the picture before in 17 of 300 frames, first in frame 222"));
}

TEST(RedKitchen, TheFirstPoseIsTheFilesMadeOrthonormal) {
    const auto folder = patina::testing::data_folder("rgbd-redkitchen");
    if (!folder) GTEST_SKIP() << patina::testing::kNoData;
    const Frame frame = std::get<Frame>(open_sequence(*folder)->next().value());
    const RigidTransform& pose = frame.world_from_camera.value();
    EXPECT_EQ(glm::dvec3(pose[3]), glm::dvec3(-0.3404563400000000239, 0.01646981800000000065, 0.2965691699999999931));
    EXPECT_NEAR(pose[1][0], 0.27262, 1e-3);  // row 1, column 2
    EXPECT_LT(rotation_defect(pose), 1e-14);
    EXPECT_EQ(std::get<Image<uint16_t>>(frame.depth).at(639, 240), 0) << "the rightmost columns are always empty";
}

}  // namespace
}  // namespace patina::sensor::red_kitchen_test
