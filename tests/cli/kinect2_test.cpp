#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <regex>
#include <string>
#include <thread>

#include "cameras/kinect2_decoder.h"
#include "scenes/kinect2/infrared_frame.h"
#include "sensor/files/picture_file.h"
#include "sensor/open.h"
#include "sensor/recording/container.h"
#include "tests/cli/run_folder.h"
#include "tests/simulated_kinect2/pages.h"

// patina live and record with a Kinect v2: the stand-in for libusb sends what the forward model makes of a corner of a
// room.

namespace patina::testing::kinect2_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr float kWall_m = 2;
constexpr float kBox_m = 1.4f;
/// Infrared frames that may be without a picture: it comes two frames later, and a busy machine may lose some.
constexpr int64_t kOnTheirWay = 5;
constexpr double kMeanGain = (1.322581 + 1.0 + 1.612903) / 3;  // of the frequencies, as libfreenect2 has them

/// A wall with a box before it, as depths along the axis; a floor and a ceiling hold the camera in place.
float depth_at(const Intrinsics& camera, uint32_t x, uint32_t y) {
    const double rx = (x - camera.cx) / camera.fx, ry = (y - camera.cy) / camera.fy;
    const double box = std::abs(rx) < 0.25 && std::abs(ry) < 0.2 ? kBox_m : kWall_m;
    const double floor = ry != 0 ? 0.9 / std::abs(ry) : 100;
    const double side = rx != 0 ? 1.1 / std::abs(rx) : 100;
    return static_cast<float>(std::min({box, floor, side}));
}

/// One infrared frame, which the stand-in repeats.
void write_infrared(const fs::path& file) {
    const kinect2::CameraModel model = cameras::camera_model(sensor::kinect2::testing::simulated_calibration());
    Image<float> depth_m(model.depth.extent);
    for (uint32_t y = 0; y < depth_m.extent().height; ++y)
        for (uint32_t x = 0; x < depth_m.extent().width; ++x) depth_m.at(x, y) = depth_at(model.depth, x, y);
    const Image<float> amplitude = scenes::kinect2::lit_amplitude(depth_m, Image<float>(depth_m.extent(), 0.5f), 2000);
    const std::vector<uint8_t> frame = scenes::kinect2::infrared_frame({model.depth, model.p0}, {depth_m, amplitude});
    std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(frame.data()), std::ssize(frame));
}

void write_color(const fs::path& folder) {
    fs::create_directories(folder);
    Image<SrgbPixel> picture(Extent2D{1920, 1080});
    for (uint32_t y = 0; y < 1080; ++y)
        for (uint32_t x = 0; x < 1920; ++x) picture.at(x, y) = SrgbPixel(60 + x / 16, 60 + y / 12, 90 + (x + y) / 24);
    sensor::testing::write_jpeg(folder / "000000.jpg", picture);
}

class Kinect2Commands : public RunFolderTest {
  protected:
    Kinect2Commands() {
        write_infrared(beside("infrared.bin"));
        write_color(beside("color"));
    }

    /// `changes`: variables of the stand-in, without their prefix. At 5 frames a second a busy machine loses nothing.
    Program::Environment with_kinect(const Program::Environment& changes = {}) const {
        Program::Environment environment{{"LD_LIBRARY_PATH", PATINA_STAND_IN_FOLDER},
                                         {"PATINA_KINECT2_RATE", "5"},
                                         {"PATINA_KINECT2_INFRARED", beside("infrared.bin")},
                                         {"PATINA_KINECT2_COLOR", beside("color")}};
        for (const auto& [name, value] : changes) environment.emplace_back("PATINA_KINECT2_" + name, value);
        return environment;
    }

    static void expect_same_rows(const fs::path& one, const fs::path& other) {
        sensor::RecordingFile a(one), b(other);
        const auto& sequence = a.sequence(sensor::SequenceRole::kMain);
        ASSERT_EQ(b.sequence(sensor::SequenceRole::kMain).info.frames, sequence.info.frames);
        EXPECT_EQ(b.sequence(sensor::SequenceRole::kMain).attachments.size(), sequence.attachments.size());
        for (uint32_t i = 0; i < *sequence.info.frames; ++i) {
            const auto frame = std::get<sensor::RecordedFrame>(a.read(sensor::SequenceRole::kMain, i));
            const auto same = std::get<sensor::RecordedFrame>(b.read(sensor::SequenceRole::kMain, i));
            EXPECT_EQ(same.timestamp_s, frame.timestamp_s);
            for (size_t k = 0; k < frame.payloads.size(); ++k) {
                EXPECT_EQ(same.payloads.at(k).number, frame.payloads[k].number);
                EXPECT_TRUE(same.payloads.at(k).content == frame.payloads[k].content);
            }
        }
    }

    /// A raw recording is recorded anew as it is, as fast as it is read or as it plays.
    static void expect_copies_of_its_rows(const fs::path& file) {
        for (const bool plays : {false, true}) {
            const fs::path copy = file.string() + (plays ? "-played.patina" : "-copy.patina");
            std::vector<std::string> arguments{"record", file, "--out", copy, "--quiet"};
            if (plays) arguments.emplace_back("--simulate");
            const Outcome copied = patina(arguments);
            ASSERT_EQ(copied.exit_code, 0) << copied.err;
            expect_same_rows(file, copy);
        }
    }

    /// A raw recording plays as the Kinect did: the run's device decodes the frames that it takes.
    void expect_to_play_live(const fs::path& file) {
        const fs::path again = beside("again.patina");
        const Outcome played = patina({"live", "--simulate", file, "--lighting", "none", "--texture", "off", "--no-map",
                                       "--out", beside("live"), "--record", again, "--quiet"});
        ASSERT_EQ(played.exit_code, 0) << played.err;
        const nlohmann::json summary = summary_of(beside("live"));
        EXPECT_GE(taken(summary), 1u);
        EXPECT_EQ(summary["live"]["captured"].get<uint32_t>(),
                  *sensor::RecordingFile(file).sequence(sensor::SequenceRole::kMain).info.frames);
        EXPECT_GT(fs::file_size(beside("live") / "scene.glb"), 100000u);
        expect_same_rows(file, again);
    }

    static void expect_infrared_in_export(const fs::path& file, const fs::path& folder) {
        const Outcome exported = patina({"export", file, "--native", folder, "--quiet"});
        ASSERT_EQ(exported.exit_code, 0) << exported.err;
        const auto files = files_in(folder);
        const auto pictures = [&](const char* start) {
            return std::ranges::count_if(files, [&](const auto& f) { return f.first.starts_with(start); });
        };
        EXPECT_EQ(pictures("infrared/"), pictures("depth/"));
        const auto light =
            std::get<Image<uint16_t>>(sensor::read_depth(folder / "infrared/000000.png", Extent2D{512, 424}));
        // 16 times the amplitude: the box reflects a half of 2000, 1.4 m away.
        EXPECT_NEAR(light.at(256, 212), kMeanGain * 16 * 0.5 * 2000 / (kBox_m * kBox_m), 250);
    }

    /// Decoded frames read as the raw ones do, but for the infrared pictures.
    static void expect_the_same_decoded(const fs::path& raw, const fs::path& raw_exported, const fs::path& decoded) {
        const Outcome recorded = patina({"record", raw, "--decoded", "--out", decoded, "--quiet"});
        ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
        EXPECT_LT(fs::file_size(decoded), fs::file_size(raw) / 2);
        const fs::path exported = decoded.string() + "-native";
        const Outcome outcome = patina({"export", decoded, "--native", exported, "--quiet"});
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        auto expected = files_in(raw_exported);
        std::erase_if(expected, [](const auto& file) { return file.first.starts_with("infrared/"); });
        EXPECT_TRUE(files_in(exported) == expected);
    }

    /// Frames that were fused, or repeat what was: this device sends the same picture again and again.
    static uint64_t taken(const nlohmann::json& summary) {
        return summary["frames"]["used"].get<uint64_t>() + summary["frames"].value("repeated", uint64_t{0});
    }

    const fs::path file_ = beside("room.patina"), cable_ = beside("unplugged");
};

TEST_F(Kinect2Commands, LiveReconstructsWhatTheKinectSees) {
    const Outcome outcome = patina({"live", "kinect2", "--seconds", "3", "--texture", "off", "--no-map", "--out", out(),
                                    "--record", file_, "--quiet"},
                                   with_kinect());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const nlohmann::json summary = summary_of(out());
    EXPECT_EQ(summary["finished"], true);
    EXPECT_GE(taken(summary), 2u);
    EXPECT_GE(summary["live"]["captured"], taken(summary));
    EXPECT_GT(summary["live"]["exposure_to_pose"]["median_ms"], 0);
    EXPECT_GT(fs::file_size(out() / "scene.glb"), 100000u);
    // All frames were recorded, those that were dropped too.
    EXPECT_EQ(summary["live"]["recordings"].at(0)["frames"], summary["live"]["captured"]);
    sensor::RecordingFile recording(file_);
    EXPECT_EQ(recording.sequence(sensor::SequenceRole::kMain).info.frames, summary["live"]["captured"].get<uint32_t>());
}

TEST_F(Kinect2Commands, ARecordingHoldsWhatTheKinectSentAndReconstructs) {
    const Outcome recorded =
        patina({"record", "kinect2", "--seconds", "0.3", "--out", file_, "--quiet"}, with_kinect());
    ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
    {
        sensor::RecordingFile recording(file_);
        EXPECT_TRUE(recording.ended(sensor::SequenceRole::kMain));
        EXPECT_EQ(recording.sequence(sensor::SequenceRole::kMain).attachments.size(), 5u);
        const auto frame = std::get<sensor::RecordedFrame>(recording.read(sensor::SequenceRole::kMain, 1));
        const std::vector<uint8_t>& infrared = frame.payloads.at(0).content;
        EXPECT_TRUE(std::string(infrared.begin(), infrared.end()) ==
                    sensor::testing::read_text(beside("infrared.bin")));
        // The simulated device's clock tells 30 frames a second, whatever their rate is; lost ones may lie between.
        const double frames = frame.timestamp_s * 30;
        EXPECT_GT(frames, 0.9);
        EXPECT_NEAR(frames, std::round(frames), 0.05);
    }
    const Outcome info = patina({"info", file_});
    EXPECT_EQ(info.exit_code, 0) << info.err;
    EXPECT_THAT(info.out, HasSubstr(" 0 skipped"));
    // Nothing is farther than the wall, which fills more than a twentieth; 11-bit codes cost less than a centimetre.
    std::smatch farthest;
    ASSERT_TRUE(std::regex_search(info.out, farthest, std::regex("95 % below ([0-9.]+) m"))) << info.out;
    EXPECT_NEAR(std::stod(farthest[1]), kWall_m, 0.01);
    expect_copies_of_its_rows(file_);
    expect_to_play_live(file_);
    expect_infrared_in_export(file_, beside("native"));
    expect_the_same_decoded(file_, beside("native"), beside("decoded.patina"));
    const nlohmann::json summary =
        run_quietly(beside("decoded.patina"), {"--frames", "3", "--lighting", "none", "--texture", "off", "--no-map"});
    EXPECT_EQ(taken(summary), 3u);
    EXPECT_GT(fs::file_size(out() / "scene.glb"), 100000u);
}

TEST_F(Kinect2Commands, AnUnpluggedKinectLeavesWhatWasFused) {
    const fs::path recording = beside("live.patina");
    Program program({"live", "kinect2", "--texture", "off", "--out", out(), "--record", recording, "--quiet"},
                    with_kinect({{"UNPLUG_FILE", cable_}}));
    await_frames(program, recording, sensor::SequenceRole::kMain);
    std::ofstream(cable_) << "now";
    EXPECT_THAT(expect_failure(program.wait()),
                AllOf(HasSubstr("unplugged"), HasSubstr("holds what could still be written")));
    EXPECT_GT(fs::file_size(out() / "scene.glb"), 100000u);
}

/// Three times as many frames come as this device decodes, so that most of them wait when the cable comes out.
TEST_F(Kinect2Commands, WhatWaitsToBeDecodedWhenTheKinectIsUnpluggedIsRecorded) {
    Program::Environment slow = with_kinect({{"UNPLUG_FILE", cable_}, {"RATE", "10"}});
    slow.insert(slow.end(), {{"VK_LAYER_PATH", PATINA_FAULT_LAYER_FOLDER},
                             {"VK_INSTANCE_LAYERS", "VK_LAYER_PATINA_fault"},
                             {"PATINA_FAULT", "vkQueueSubmit2 0 0 300"}});
    Program program({"record", "kinect2", "--decoded", "--out", file_, "--quiet"}, slow);
    await_frames(program, file_, sensor::SequenceRole::kMain);
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    std::ofstream(cable_) << "now";
    EXPECT_THAT(expect_failure(program.wait()), AllOf(HasSubstr("unplugged"), HasSubstr("frames")));
    const int64_t sent = std::stoll(sensor::testing::read_text(cable_.string() + ".sent"));
    sensor::RecordingFile recording(file_);
    const uint32_t frames = *recording.sequence(sensor::SequenceRole::kMain).info.frames;
    ASSERT_GT(frames, 0u);
    const auto number_of = [&](uint32_t index) {
        return std::get<sensor::RecordedFrame>(recording.read(sensor::SequenceRole::kMain, index))
            .payloads.at(0)
            .number;
    };
    EXPECT_GE(number_of(frames - 1) + kOnTheirWay, sent) << "of " << frames << " frames from " << number_of(0);
    const auto source = sensor::open_sequence(file_);  // without a device
    const auto frame = std::get<Frame>(*source->next());
    EXPECT_NEAR(std::get<Image<float>>(frame.depth).at(256, 212), kBox_m, 0.01);
}

TEST_F(Kinect2Commands, WhatIsLostOnTheWayIsCounted) {
    const Program::Environment losing = with_kinect({{"LOSE_EVERY", "4"}});
    const Outcome outcome = patina({"live", "kinect2", "--seconds", "3", "--texture", "off", "--no-map", "--out", out(),
                                    "--record", file_, "--quiet"},
                                   losing);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const nlohmann::json live = summary_of(out())["live"];
    const auto captured = live["captured"].get<uint32_t>(), lost = live["lost"].get<uint32_t>();
    EXPECT_GT(lost, 1u);
    EXPECT_GT(captured, lost);
    EXPECT_LE(captured, 4 * lost + 4) << "every fourth was lost, at least";
    // The device numbers what it sends: of those from the first to the last that came, what is missing was lost.
    sensor::RecordingFile recording(file_);
    const auto number_of = [&](uint32_t index) {
        return std::get<sensor::RecordedFrame>(recording.read(sensor::SequenceRole::kMain, index))
            .payloads.at(0)
            .number;
    };
    EXPECT_LE(number_of(captured - 1) - number_of(0) + 1, captured + lost);
    EXPECT_GE(number_of(captured - 1) - number_of(0) + 4, captured + lost);
    const Outcome recorded = patina({"record", "kinect2", "--seconds", "1", "--out", beside("other.patina")}, losing);
    ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
    EXPECT_THAT(recorded.out, HasSubstr("frames were lost on the way from the camera"));
}

TEST_F(Kinect2Commands, TwoPassesGoIntoOneFileTheSecondAtALowExposure) {
    Program program({"record", "kinect2", "--lighting", "kinect2", "--low-exposure", "2", "--out", file_},
                    with_kinect());
    for (const auto role : {sensor::SequenceRole::kMain, sensor::SequenceRole::kLighting}) {
        await_frames(program, file_, role);
        program.send(SIGINT);
    }
    const Outcome recorded = program.wait();
    ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
    EXPECT_THAT(recorded.err, AllOf(HasSubstr("sequence 1 of 2: reflectance"), HasSubstr("sequence 2 of 2: low")));
    sensor::RecordingFile recording(file_);
    for (const auto role : {sensor::SequenceRole::kMain, sensor::SequenceRole::kLighting}) {
        EXPECT_TRUE(recording.ended(role));
        EXPECT_EQ(recording.sequence(role).attachments.size(), 5u);
        ASSERT_GT(*recording.sequence(role).info.frames, 0u);
        EXPECT_TRUE(std::holds_alternative<sensor::RecordedFrame>(recording.read(role, 0)));
    }
    EXPECT_THAT(expect_failure(patina({"record", "kinect2", "--lighting", "elsewhere", "--out", beside("b.patina")},
                                      with_kinect())),
                HasSubstr("--lighting kinect2, not --lighting elsewhere"));
    EXPECT_FALSE(fs::exists(beside("b.patina")));
}

TEST_F(Kinect2Commands, WithoutAFrameThereIsOneSentenceAndNoFile) {
    const Program::Environment silent = with_kinect({{"LOSE_EVERY", "1"}});
    EXPECT_THAT(expect_failure(patina({"record", "kinect2", "--out", file_, "--quiet"}, silent)),
                HasSubstr("no infrared frame arrived whole"));
    EXPECT_FALSE(fs::exists(file_));
    EXPECT_THAT(expect_failure(patina({"live", "kinect2", "--out", out(), "--record", file_, "--quiet"}, silent)),
                HasSubstr("no infrared frame arrived whole"));
    EXPECT_FALSE(fs::exists(file_));
}

TEST_F(Kinect2Commands, WithoutAKinectThereIsOneSentenceAndNoFile) {
    const Program::Environment none = with_kinect({{"DEVICE", "none"}});
    expect_failure(patina({"record", "kinect2", "--out", file_}, none));
    expect_failure(patina({"live", "kinect2", "--out", out()}, none));
    EXPECT_FALSE(fs::exists(file_));
    EXPECT_FALSE(fs::exists(out()));
}

}  // namespace
}  // namespace patina::testing::kinect2_test
