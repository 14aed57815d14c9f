#include "sensor/inspect.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>

#include "sensor/open.h"
#include "tests/sensor/sequences.h"

namespace patina::sensor::inspect_test {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

SequenceReport report_of(const SequenceInfo& info, std::vector<Reading> readings) {
    MemorySource source(info, std::move(readings));
    return inspect(source);
}

Frame& frame_at(std::vector<Reading>& readings, size_t index) { return std::get<Frame>(readings.at(index)); }

TEST(Inspect, ASoundSequenceHasNoWarnings) {
    const SequenceReport report = report_of(test_info(), test_readings(4));
    EXPECT_THAT(report.warnings, IsEmpty());
    EXPECT_EQ(report.usable_frames, 4u);
    EXPECT_NEAR(report.duration_s, 0.1, 1e-12);
    EXPECT_NEAR(report.depth_view_deg.x, 60, 0.01);  // 2 atan(0.5 / 0.866)
    EXPECT_EQ(report.poses.frames, 4u);
    EXPECT_NEAR(report.poses.path_length_m, 0.3, 1e-12);
    EXPECT_NEAR(report.poses.translation_m.value, 0.1, 1e-12);
    EXPECT_EQ(report.poses.rotation_deg.value, 0);
}

TEST(Inspect, PixelStatisticsAreThoseOfThePixels) {
    SequenceInfo info = test_info();
    info.depth = test_camera({100, 70});
    info.color = test_camera({10, 10});
    Frame frame = test_frame(0, {10, 10}, {100, 70});
    Image<uint16_t> depth({100, 70}, 0);
    for (uint32_t i = 0; i < 5250; ++i)
        depth.pixels()[i] = static_cast<uint16_t>(1000 + i);  // three quarters are valid
    Image<SrgbPixel> color({10, 10}, SrgbPixel(10, 20, 30));
    for (uint32_t i = 0; i < 25; ++i) color.pixels()[i] = SrgbPixel(255, 20, 30);
    frame.depth = depth;
    frame.color = color;
    const SequenceReport report = report_of(info, {frame});
    EXPECT_DOUBLE_EQ(report.depth.valid_share, 0.75);
    // Percentiles come from every 7th reading, here 7 mm apart.
    EXPECT_NEAR(report.depth.p5_m, 1.0 + 0.05 * 5.25, 0.014);
    EXPECT_NEAR(report.depth.median_m, 1.0 + 0.5 * 5.25, 0.014);
    EXPECT_NEAR(report.depth.p95_m, 1.0 + 0.95 * 5.25, 0.014);
    EXPECT_DOUBLE_EQ(report.color.clipped_share, 0.25);
    EXPECT_DOUBLE_EQ(report.color.mean.r, 0.25 * 255 + 0.75 * 10);
    EXPECT_DOUBLE_EQ(report.color.mean.b, 30);
    EXPECT_FALSE(report.color.linear);
}

TEST(Inspect, SamplesPixelsButGoesThroughAllPoses) {
    const SequenceReport report = report_of(test_info(), test_readings(120));
    EXPECT_EQ(report.sampled_frames, 40u);  // every third
    EXPECT_EQ(report.poses.frames, 120u);
}

TEST(Inspect, WarnsOfImplausibleScale) {
    SequenceInfo info = test_info();
    info.metres_per_unit = 1;
    EXPECT_THAT(report_of(info, test_readings(1)).warnings,
                ElementsAre(HasSubstr("the median depth is 1013 m, outside 0.2 to 10 m; if the scale is wrong, "
                                      "metres_per_unit may be 0.001 instead of 1 in sequence.json")));
    info.format = "tum";
    EXPECT_THAT(report_of(info, test_readings(1)).warnings,
                ElementsAre(HasSubstr("the unit of depth may be 0.001 m, but the format tum fixes it at 1 m")));
    std::vector<Reading> readings = test_readings(1);
    frame_at(readings, 0).depth = Image<uint16_t>({16, 12});
    EXPECT_THAT(report_of(test_info(), readings).warnings, ElementsAre("no depth picture has a valid reading"));
}

TEST(Inspect, WarnsOfImplausibleIntrinsics) {
    const auto warnings = [](auto change) {
        SequenceInfo info = test_info();
        change(info);
        return report_of(info, test_readings(1)).warnings;
    };
    EXPECT_THAT(warnings([](SequenceInfo& i) { i.depth.fx = i.depth.fy = 100; }),
                ElementsAre(HasSubstr("the depth camera's field of view is 9.1 x 6.9 degrees, outside 20 to 120")));
    EXPECT_THAT(warnings([](SequenceInfo& i) { i.color.fx = i.color.fy = 9; }),
                ElementsAre(HasSubstr("the colour camera's field of view is 121.3 x")));
    EXPECT_THAT(
        warnings([](SequenceInfo& i) { i.color.cx = 23; }),
        ElementsAre("the colour camera's principal point is (23, 11.5), far from the picture's centre (15.5, 11.5)"));
    EXPECT_THAT(warnings([](SequenceInfo& i) { i.depth.cy = 0; }),
                ElementsAre(HasSubstr("the depth camera's principal point is (7.5, 0)")));
    EXPECT_THAT(warnings([](SequenceInfo& i) { i.depth.fx *= 1.06; }),
                ElementsAre(HasSubstr("the depth camera's pixels are not square")));
}

TEST(Inspect, WarnsOfImplausiblePoses) {
    const auto warnings = [](auto change) {
        std::vector<Reading> readings = test_readings(4);
        change(readings);
        return report_of(test_info(), readings).warnings;
    };
    EXPECT_THAT(warnings([](auto& r) {
                    for (size_t i : {2, 3}) (*frame_at(r, i).world_from_camera)[3].y = 0.5;
                }),
                ElementsAre("the camera jumps by 0.51 m at frame 2, more than 0.5 m"));
    EXPECT_THAT(warnings([](auto& r) {
                    RigidTransform& pose = *frame_at(r, 3).world_from_camera;
                    pose = glm::rotate(pose, glm::radians(31.0), glm::dvec3(0, 0, 1));
                }),
                ElementsAre("the camera turns by 31.0 degrees at frame 3, more than 30"));
    EXPECT_THAT(warnings([](auto& r) { frame_at(r, 1).pose_defect = 0.005; }),
                ElementsAre("rotations were repaired that are off by up to 0.005, more than 0.001"));
    EXPECT_THAT(warnings([](auto& r) { frame_at(r, 1).world_from_camera.reset(); }),
                ElementsAre("1 of 4 usable frames have no pose"));
}

TEST(Inspect, AGapOfSkippedFramesIsNoJump) {
    std::vector<Reading> readings = test_readings(12);
    for (uint32_t i = 2; i < 10; ++i) readings[i] = Skipped{i, "damaged"};
    const SequenceReport report = report_of(test_info(), readings);
    EXPECT_THAT(report.warnings, IsEmpty());
    EXPECT_EQ(report.skipped.size(), 8u);
    EXPECT_NEAR(report.poses.path_length_m, 1.1, 1e-12);
}

TEST(Inspect, WarnsOfRepetitionsAndTimestamps) {
    std::vector<Reading> readings = test_readings(4);
    frame_at(readings, 2).depth = frame_at(readings, 1).depth;
    frame_at(readings, 3).color = frame_at(readings, 2).color;
    frame_at(readings, 2).timestamp_s = frame_at(readings, 1).timestamp_s;
    EXPECT_THAT(report_of(test_info(), readings).warnings,
                ElementsAre("the timestamp is not later than the one before in 1 of 4 frames, first in frame 2",
                            "colour repeats the picture before in 1 of 4 frames, first in frame 3",
                            "depth repeats the picture before in 1 of 4 frames, first in frame 2"));
}

TEST(Inspect, NothingUsableIsAWarning) {
    const SequenceReport report = report_of(test_info(), {Skipped{0, "c.png is missing"}});
    EXPECT_THAT(report.warnings, ElementsAre("no frame is usable"));
    EXPECT_THAT(format_report(report), HasSubstr("frame 0: c.png is missing"));
}

TEST(Inspect, TheTextShowsTheNumbers) {
    const std::string report = format_report(report_of(test_info(), test_readings(2)));
    EXPECT_THAT(report, HasSubstr("test (patina-sequence)"));
    EXPECT_THAT(report, HasSubstr("2, 2 usable, 0 skipped"));
    EXPECT_THAT(
        report,
        HasSubstr("32 x 24, fx 27.712 fy 27.712 cx 15.5 cy 11.5, no distortion, field of view 60.0 x 46.8 degrees"));
    EXPECT_THAT(report, HasSubstr("registered to depth"));
}

}  // namespace
}  // namespace patina::sensor::inspect_test
