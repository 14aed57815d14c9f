#include "reconstruction/session/preflight.h"

#include "sensor/files/picture_file.h"
#include "sensor/open.h"
#include "sensor/pose.h"
#include "tests/cli/run_folder.h"

namespace patina::tools::preflight_test {
namespace {

namespace fs = std::filesystem;
using sensor::testing::replace_text;
using sensor::testing::write_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class PreflightTest : public ::testing::Test {
  protected:
    /// Writes a native sequence of so many test frames.
    SessionOptions recording(uint32_t frames) {
        sensor::testing::write_native(folder_ / "sequence", frames);
        SessionOptions options;
        options.sequence = (folder_ / "sequence").string();
        return options;
    }

    fs::path file(const std::string& name) const { return folder_ / ("sequence/" + name); }

    /// As a session looks at it.
    static Preflight preflight(const SessionOptions& options) {
        sensor::LookAheadSource source(sensor::open_sequence(options.sequence));
        return look_ahead(source, options);
    }

  private:
    const sensor::testing::TemporaryFolder folder_;
};

TEST_F(PreflightTest, ALongRecordingIsNotJudgedByItsFirstFrameAlone) {
    const SessionOptions options = recording(40);
    sensor::write_png(file("depth/000000.png"), Image<uint16_t>({16, 12}, 0));  // valid, but nothing was measured
    replace_text(file("sequence.json"), "\"frames\": 40", "\"frames\": 1600");
    for (uint32_t i = 40; i < 1600; ++i) write_text(file("color/" + sensor::picture_stem(i) + ".png"), "damaged");
    EXPECT_THAT(preflight(options).warnings, IsEmpty());
}

TEST_F(PreflightTest, LooksOnToTheFirstPose) {
    const SessionOptions options = recording(36);
    std::vector<sensor::StampedPose> poses = sensor::read_trajectory(file("trajectory.txt"));
    ASSERT_EQ(poses.size(), 36u);
    poses.erase(poses.begin(), poses.begin() + 33);
    for (sensor::StampedPose& pose : poses) pose.world_from_camera[3] += glm::dvec4(3e6, -2e6, 0, 0);
    sensor::write_trajectory(file("trajectory.txt"), poses);
    const Preflight ahead = preflight(options);
    EXPECT_NEAR(ahead.world_offset_m.x, 3e6, 5);
    EXPECT_NEAR(ahead.world_offset_m.y, -2e6, 5);
    EXPECT_EQ(ahead.world_offset_m, world_offset_of(options.sequence, ""));
    EXPECT_THAT(ahead.warnings, ElementsAre(HasSubstr("30 of 30 usable frames have no pose")))
        << "these are of the first frames";
}

TEST_F(PreflightTest, ConventionsMatterWherePosesAreUsed) {
    SessionOptions options;
    for (const Poses used : {Poses::kAuto, Poses::kGiven, Poses::kPrior}) {
        options.poses = used;
        EXPECT_EQ(convention_check(options), sensor::ConventionCheck::kOn);
    }
    options.poses = Poses::kTrack;
    EXPECT_EQ(convention_check(options), sensor::ConventionCheck::kOff);
}

}  // namespace
}  // namespace patina::tools::preflight_test
