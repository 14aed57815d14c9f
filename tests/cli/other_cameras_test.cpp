#include <cmath>
#include <cstdio>
#include <fstream>

#include "sensor/recording/container.h"
#include "tests/cli/run_folder.h"

// Cameras through libraries of others: a Kinect v1 by libfreenect's fakenect, which plays a session that the test
// writes, and OpenNI2's dummy device.

namespace patina::testing::other_cameras_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

constexpr uint32_t kWidth = 640, kHeight = 480;
constexpr double kFocal_px = 580;

/// The 11 bits of disparity of a depth, by the inverse of the nominal formula.
uint16_t raw_of(double depth_m) {
    return static_cast<uint16_t>(std::lround(2842.5 * (std::atan(depth_m / 0.1236) - 1.1863)));
}

/// A wall with a box before it, a floor and sides, which hold the camera in place.
double depth_at(uint32_t x, uint32_t y) {
    const double rx = (x - 319.5) / kFocal_px, ry = (y - 239.5) / kFocal_px;
    const double box = std::abs(rx) < 0.25 && std::abs(ry) < 0.2 ? 1.4 : 2;
    return std::min({box, 0.9 / std::abs(ry), 1.1 / std::abs(rx)});
}

/// A picture file of fakenect: a line, then the pixels as the library hands them out.
template <class Pixel, class At>
void write_picture(const fs::path& file, const char* magic, const At& at) {
    std::ofstream out(file, std::ios::binary);
    out << magic << " 640 480 65535\n";
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const Pixel pixel = at(x, y);
            out.write(reinterpret_cast<const char*>(&pixel), sizeof(Pixel));
        }
}

/// Pictures at ten a second; every name in the index stands for the one picture of its kind. `kinds`: 'd' for
/// depth, 'r' for colour, which is `color_late_s` after the depth.
void write_session(const fs::path& folder, const std::string& kinds = "dr", uint32_t frames = 30,
                   double color_late_s = 0) {
    fs::create_directories(folder);
    write_picture<uint16_t>(folder / "depth", "P5", [](uint32_t x, uint32_t y) { return raw_of(depth_at(x, y)); });
    write_picture<SrgbPixel>(folder / "color", "P6", [](uint32_t x, uint32_t y) {
        return SrgbPixel(60 + x / 8, 60 + y / 6, 90 + (x + y) / 16);
    });
    std::ofstream index(folder / "INDEX.txt");
    for (uint32_t i = 0; i < frames; ++i) {
        for (const char kind : kinds) {
            char name[64];
            const double time_s = i / 10.0 + (kind == 'r' ? color_late_s : 0);
            std::snprintf(name, sizeof(name), "%c-%.6f-%.0f.ppm", kind, time_s, 1000 + 60e6 * time_s);
            fs::create_symlink(kind == 'd' ? "depth" : "color", folder / name);
            index << name << '\n';
        }
    }
}

class OtherCameras : public RunFolderTest {
  protected:
    Program::Environment with_fakenect() const {
        return {{"LD_LIBRARY_PATH", PATINA_FAKENECT_FOLDER}, {"FAKENECT_PATH", beside("session")}};
    }

    /// Whether this program was built without the library, which is one sentence that names the package.
    static bool absent(const std::string& camera, const std::string& package) {
        const Outcome outcome = patina({"record", camera, "--out", "/nowhere/x.patina"});
        if (outcome.err.find("was not installed when it was built") == std::string::npos) return false;
        EXPECT_THAT(expect_failure(outcome), HasSubstr(package));
        return true;
    }

    static uint32_t frames_in(const fs::path& file) {
        return *sensor::RecordingFile(file).sequence(sensor::SequenceRole::kMain).info.frames;
    }
};

TEST_F(OtherCameras, AKinectV1IsReadLiveAndRecorded) {
    if (absent("kinect1", "libfreenect-dev")) return;
    if (std::string(PATINA_FAKENECT_FOLDER).empty()) GTEST_SKIP() << "fakenect is not installed";
    write_session(beside("session"));
    const fs::path beside_run = beside("beside.patina"), alone = beside("alone.patina");
    const Outcome live =
        patina({"live", "kinect1", "--seconds", "1", "--out", out(), "--record", beside_run, "--texture", "off",
                "--no-map", "--lighting", "none", "--set", "map.voxel_m=0.02", "--quiet"},
               with_fakenect());
    EXPECT_THAT(live.exit_code, AnyOf(0, 3)) << live.err;
    const auto summary = summary_of(out());
    EXPECT_EQ(summary["finished"], true);
    // 11 bits of disparity show steps, which do not hold a tracked camera: frames may be weak.
    EXPECT_GE(summary["frames"]["used"], 1u) << summary["frames"];
    EXPECT_GE(summary["frames"]["read"], 3u);
    EXPECT_EQ(summary["sequence"]["format"], "kinect1");
    EXPECT_GE(frames_in(beside_run), summary["frames"]["used"]);

    const Outcome recorded =
        patina({"record", "kinect1", "--seconds", "1", "--out", alone, "--quiet"}, with_fakenect());
    ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
    EXPECT_GE(frames_in(alone), 5u);
    sensor::RecordingFile recording(alone);
    const auto& info = recording.sequence(sensor::SequenceRole::kMain).info;
    EXPECT_EQ(info.depth.fx, kFocal_px);
    EXPECT_NEAR(info.color_from_depth[3].x, -0.025, 1e-12);
    const Outcome shown = patina({"info", alone});
    EXPECT_THAT(shown.out, HasSubstr("640")) << shown.err;
    const Outcome twice = patina({"record", "kinect1", "--lighting", "kinect1", "--out", beside("x.patina")});
    EXPECT_THAT(expect_failure(twice), HasSubstr("exposure of kinect1 cannot be set"));
    EXPECT_FALSE(fs::exists(beside("x.patina")));
}

TEST_F(OtherCameras, AKinectV1WithoutDepthEndsTheRunThoughColorGoesOn) {
    if (absent("kinect1", "libfreenect-dev")) return;
    if (std::string(PATINA_FAKENECT_FOLDER).empty()) GTEST_SKIP() << "fakenect is not installed";
    write_session(beside("session"), "r", 100);
    const Outcome outcome = patina(
        {"live", "kinect1", "--seconds", "20", "--out", out(), "--lighting", "none", "--quiet"}, with_fakenect());
    EXPECT_THAT(expect_failure(outcome), HasSubstr("no depth pictures for 5 s"));
}

TEST_F(OtherCameras, AKinectV1WhoseColorFitsNoDepthIsStillStoppedInTime) {
    if (absent("kinect1", "libfreenect-dev")) return;
    if (std::string(PATINA_FAKENECT_FOLDER).empty()) GTEST_SKIP() << "fakenect is not installed";
    write_session(beside("session"), "dr", 100, 0.05);
    const fs::path file = beside("x.patina");
    const Outcome outcome = patina({"record", "kinect1", "--seconds", "1", "--out", file, "--quiet"}, with_fakenect());
    EXPECT_EQ(outcome.exit_code, 3) << outcome.out;
    EXPECT_THAT(outcome.err,
                ContainsRegex("none of [0-9]+ frames has pictures: no colour picture came within 0.018 s"));
}

TEST_F(OtherCameras, WithoutAKinectV1ItIsOneSentence) {
    if (absent("kinect1", "libfreenect-dev")) return;
    EXPECT_THAT(expect_failure(patina({"live", "kinect1", "--out", out(), "--quiet"})),
                AnyOf(HasSubstr("no Kinect v1 is connected"), HasSubstr("cannot reach USB")));
    EXPECT_FALSE(fs::exists(out()));
}

TEST_F(OtherCameras, ACameraOfOpenNi2IsRecorded) {
    if (absent("openni2", "libopenni2-dev")) return;
    EXPECT_THAT(expect_failure(patina({"record", "openni2:/nowhere", "--out", beside("x.patina")})),
                HasSubstr("'/nowhere' cannot be opened"));
    const fs::path file = beside("dummy.patina");
    const Outcome recorded = patina({"record", "openni2:Dummy", "--seconds", "1", "--out", file, "--quiet"});
    if (recorded.err.find("cannot be opened") != std::string::npos)
        GTEST_SKIP() << "OpenNI2's dummy device is not installed";
    ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
    EXPECT_GE(frames_in(file), 5u);
}

TEST_F(OtherCameras, TheDoctorNamesThem) {
    const Outcome outcome = patina({"doctor"});
    EXPECT_THAT(outcome.out, HasSubstr("Kinect v1\n"));
    EXPECT_THAT(outcome.out, HasSubstr("OpenNI2\n"));
}

}  // namespace
}  // namespace patina::testing::other_cameras_test
