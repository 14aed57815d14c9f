#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "sensor/files/picture_file.h"
#include "sensor/open.h"
#include "sensor/write_sequence.h"
#include "tests/sensor/sequences.h"

namespace patina::sensor::readers_test {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

std::string open_error(const fs::path& path, const std::string& format = "") {
    return error_of([&] { open_sequence(path, format); });
}

const Frame& frame_at(const std::vector<Reading>& readings, size_t index) {
    return std::get<Frame>(readings.at(index));
}

const Image<uint16_t>& units(const Frame& frame) { return std::get<Image<uint16_t>>(frame.depth); }

// Opening

TEST(OpenSequence, APathThatDoesNotExistIsNamed) {
    const TemporaryFolder folder;
    EXPECT_EQ(open_error(folder / "none"), (folder / "none").string() + " does not exist");
}

TEST(OpenSequence, AFolderOfNoFormatTellsWhatWasLookedFor) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "empty");
    EXPECT_EQ(open_error(folder / "empty"),
              (folder / "empty").string() +
                  " is no sequence: it holds no sequence.json, frame-NNNNNN.depth.png, rgb.txt with depth.txt or "
                  "camera_intrinsic.json with color/ and depth/");
}

TEST(OpenSequence, AFolderOfSequencesNamesTheFirst) {
    const TemporaryFolder folder;
    write_native(folder / "scene/seq-02", 1);
    write_native(folder / "scene/seq-01", 1);
    EXPECT_THAT(open_error(folder / "scene"), EndsWith("but " + (folder / "scene/seq-01").string() + " does"));
}

TEST(OpenSequence, AFileIsRefusedUnlessItIsSequenceJson) {
    const TemporaryFolder folder;
    write_native(folder / "a", 1);
    write_text(folder / "a.bag", "x");
    EXPECT_EQ(open_sequence(folder / "a/sequence.json")->info().frames, 1u);
    EXPECT_THAT(open_error(folder / "a.bag"), HasSubstr("a.bag is a file, but a sequence is a folder"));
}

TEST(OpenSequence, TheFormatCanBeGiven) {
    const TemporaryFolder folder;
    write_native(folder / "a", 1);
    EXPECT_EQ(open_sequence(folder / "a", "patina-sequence")->info().format, "patina-sequence");
    EXPECT_THAT(open_error(folder / "a", "tum"), HasSubstr("depth.txt does not exist"));
    EXPECT_EQ(open_error(folder / "a", "sens"),
              "format 'sens' is not known, must be patina-sequence, 7-scenes, tum or open3d");
}

// Native

TEST(NativeReader, ReadsEveryFieldOfSequenceJson) {
    const TemporaryFolder folder;
    write_native(folder / "a", 1);
    write_text(folder / "a/sequence.json",
               R"({"format": "patina-sequence", "version": 1, "name": "n", "fps": 25, "frames": 1,
        "color": {"width": 32, "height": 24, "fx": 30, "fy": 31, "cx": 15, "cy": 11, "distortion": [1, 2, 3, 4, 5],
                  "exposure_s": 0.02, "gain": 4},
        "depth": {"width": 16, "height": 12, "fx": 20, "fy": 21, "cx": 7, "cy": 5, "distortion": [0, 0, 0, 0, 1],
                  "metres_per_unit": 0.0002, "max_metres": 3},
        "depth_to_color": [0,-1,0,0.5, 1,0,0,0.25, 0,0,1,0.125, 0,0,0,1], "gravity": [0, 9.5, 2]})");
    const auto source = open_sequence(folder / "a");
    const SequenceInfo& info = source->info();
    EXPECT_EQ(info.name, "n");
    EXPECT_EQ(info.fps, 25);
    EXPECT_EQ(info.color, (Intrinsics{{32, 24}, 30, 31, 15, 11, {1, 2, 3, 4, 5}}));
    EXPECT_EQ(info.depth, (Intrinsics{{16, 12}, 20, 21, 7, 5, {0, 0, 0, 0, 1}}));
    EXPECT_EQ(info.metres_per_unit, 0.0002);
    EXPECT_EQ(info.max_metres, 3);
    EXPECT_EQ(info.color_from_depth * glm::dvec4(1, 0, 0, 1), glm::dvec4(0.5, 1.25, 0.125, 1));
    EXPECT_EQ(info.gravity.value(), glm::dvec3(0, 9.5, 2));
    EXPECT_EQ(frame_at(read_all(*source), 0).exposure, (Exposure{0.02, 4}));
}

TEST(NativeReader, WhatMayBeLeftOutHasItsDefault) {
    const TemporaryFolder folder;
    write_native(folder / "a", 1);
    write_text(folder / "a/sequence.json", R"({"format": "patina-sequence", "version": 1, "frames": 1,
        "color": {"width": 32, "height": 24, "fx": 30, "fy": 31, "cx": 15, "cy": 11},
        "depth": {"width": 16, "height": 12, "fx": 20, "fy": 21, "cx": 7, "cy": 5, "metres_per_unit": 0.001}})");
    fs::remove(folder / "a/trajectory.txt");
    const auto source = open_sequence(folder / "a/");
    EXPECT_EQ(source->info().name, "a");
    EXPECT_EQ(source->info().fps, 30);
    EXPECT_EQ(source->info().color_from_depth, RigidTransform(1.0));
    EXPECT_FALSE(source->info().has_poses);
    EXPECT_FALSE(source->info().gravity);
    EXPECT_FALSE(frame_at(read_all(*source), 0).world_from_camera);
}

struct JsonFault {
    const char* from;
    const char* to;
    const char* message;
};

class SequenceJsonFault : public ::testing::TestWithParam<JsonFault> {};

TEST_P(SequenceJsonFault, IsNamedWithItsKey) {
    const TemporaryFolder folder;
    write_native(folder / "a", 2);
    const fs::path file = folder / "a/sequence.json";
    write_text(file,
               nlohmann::json::parse(read_text(file)).dump());  // compact, so that a fault is one short replacement
    replace_text(file, GetParam().from, GetParam().to);
    EXPECT_THAT(open_error(folder / "a"), HasSubstr(file.string() + GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Each, SequenceJsonFault,
    ::testing::Values(
        JsonFault{"\"frames\":2", "\"frames\":0", ": frames is 0, must be a positive whole number"},
        JsonFault{"\"frames\":2", "\"frames\":-2", ": frames is -2, must be a positive whole number"},
        JsonFault{"\"frames\":2", "\"frames\":1e20", ": frames is 1e+20, must be a positive whole number"},
        JsonFault{"\"frames\":2,", "", ": frames is missing"},
        JsonFault{"\"frames\":2,", "\"frames\":2,\"gravity\":[0,1],", ": gravity is [0,1], must be"},
        JsonFault{"\"frames\":2,", "\"frames\":2,\"gravity\":[0,0,0],", ": gravity is [0, 0, 0], which is no"},
        JsonFault{"\"fps\":30.0", "\"fps\":0", ": fps is 0, must be positive"},
        JsonFault{"\"color\":{", "\"colour\":{", ": color is missing"},
        JsonFault{"\"metres_per_unit\":0.001,", "", ": depth.metres_per_unit is missing"},
        JsonFault{"\"metres_per_unit\":0.001", "\"metres_per_unit\":\"mm\"",
                  ": depth.metres_per_unit is \"mm\", must be a number"},
        JsonFault{"\"fx\":13.856", "\"fx\":-3", ": depth.fx is -3, must be positive"},
        JsonFault{"\"fx\":13.856,", "", ": depth.fx is missing"},
        JsonFault{"\"depth_to_color\":[1.0,", "\"depth_to_color\":[1.5,", ": depth_to_color: the pose is not rigid"},
        JsonFault{"\"depth_to_color\":[1.0,", "\"depth_to_color\":[", ": depth_to_color is ["},
        JsonFault{"\"version\":1", "\"version\":2", ": version is 2, but this program reads version 1"},
        JsonFault{"\"patina-sequence\"", "\"other\"", ": format is \"other\", must be \"patina-sequence\""},
        JsonFault{"\"width\":32", "\"width\":64", ": color is 64 x 24 pixels, but"},
        JsonFault{"\"version\":1}", "\"version\":1", " is not valid JSON: "}));

TEST(NativeReader, PosesBelongToTheNearestTimestamp) {
    const TemporaryFolder folder;
    write_native(folder / "a", 3);
    write_text(folder / "a/timestamps.txt", "0 100\n2 101 # late\n1 100.5\n");
    write_text(folder / "a/trajectory.txt",
               "# comment\n100.01 1 0 0 0 0 0 1\n100.005 2 0 0 0 0 0 1\n\n101.01 3 0 0 0 0 0.70710678 "
               "0.70710678\n100.53 4 0 0 0 0 0 1\n");
    const auto source = open_sequence(folder / "a");
    const std::vector<Reading> readings = read_all(*source);
    EXPECT_TRUE(source->info().has_poses);
    EXPECT_EQ(frame_at(readings, 0).timestamp_s, 100);
    EXPECT_EQ(frame_at(readings, 2).timestamp_s, 101);
    EXPECT_EQ((*frame_at(readings, 0).world_from_camera)[3].x, 2);  // 5 ms away, though listed after one 10 ms away
    EXPECT_FALSE(frame_at(readings, 1).world_from_camera) << "the nearest pose is 30 ms away";
    // A quarter turn about z takes x to y: the quaternion's order is x y z w.
    EXPECT_NEAR((*frame_at(readings, 2).world_from_camera)[0].y, 1, 1e-7);
    EXPECT_LT(rotation_defect(*frame_at(readings, 2).world_from_camera), 1e-14);
}

TEST(NativeReader, ExposuresVaryWhereListed) {
    const TemporaryFolder folder;
    write_native(folder / "a", 2);
    write_text(folder / "a/exposures.txt", "1 0.004 2.5\n");
    const auto readings = read_all(*open_sequence(folder / "a"));
    EXPECT_EQ(frame_at(readings, 0).exposure, Exposure{});
    EXPECT_EQ(frame_at(readings, 1).exposure, (Exposure{0.004, 2.5}));
}

TEST(NativeReader, ExposuresAreKnownWhereAFileTellsThem) {
    const TemporaryFolder folder;
    SequenceInfo info = test_info();
    info.exposure_known = false;
    SequenceWriter writer(folder / "a", info);
    for (Reading& reading : test_readings(2)) {
        Frame& frame = std::get<Frame>(reading);
        frame.exposure.gain = 1 + frame.index;
        writer.write(frame);
    }
    writer.finish();
    EXPECT_FALSE(open_sequence(folder / "a")->info().exposure_known);
    write_text(folder / "a/exposures.txt", "1 0.004 2.5\n");
    EXPECT_TRUE(open_sequence(folder / "a")->info().exposure_known);
    write_native(folder / "b", 1);
    EXPECT_TRUE(open_sequence(folder / "b")->info().exposure_known) << "sequence.json tells it";
}

TEST(NativeReader, MotionBlurIsAKeyAndTruthChangesNothing) {
    const TemporaryFolder folder;
    write_native(folder / "a", 1);
    EXPECT_TRUE(open_sequence(folder / "a")->info().motion_blur) << "a camera's pictures blur";
    fs::create_directory(folder / "a/truth");
    EXPECT_TRUE(open_sequence(folder / "a")->info().motion_blur);
    replace_text(folder / "a/sequence.json", "\"exposure_s\"", "\"motion_blur\": false, \"exposure_s\"");
    EXPECT_FALSE(open_sequence(folder / "a")->info().motion_blur);
    replace_text(folder / "a/sequence.json", "\"motion_blur\": false", "\"motion_blur\": 0");
    EXPECT_THAT(open_error(folder / "a"), HasSubstr("color.motion_blur is 0, must be true or"));
}

struct ListFault {
    const char* file;
    const char* content;
    const char* message;
};

class NativeListFault : public ::testing::TestWithParam<ListFault> {};

TEST_P(NativeListFault, IsNamedWithItsLine) {
    const TemporaryFolder folder;
    write_native(folder / "a", 2);
    write_text(folder / ("a/" + std::string(GetParam().file)), GetParam().content);
    EXPECT_THAT(open_error(folder / "a"), HasSubstr((folder / "a").string() + "/" + GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Each, NativeListFault,
    ::testing::Values(
        ListFault{"timestamps.txt", "0 1\n", "timestamps.txt has no line for frame 1 of 2"},
        ListFault{"timestamps.txt", "0 1\n1 x\n", "timestamps.txt:2: 'x' in column 2 is not a number"},
        ListFault{"timestamps.txt", "0 1\n1 nan\n", "timestamps.txt:2: column 2 is nan, must be finite"},
        ListFault{"timestamps.txt", "0 1\n2 2\n", "timestamps.txt:2: index is 2, but there are 2 frames"},
        ListFault{"timestamps.txt", "0 1\n0 2\n", "timestamps.txt:2: index 0 appears a second time"},
        ListFault{"timestamps.txt", "0\n", "timestamps.txt:1 has 1 columns, must have 2: index timestamp"},
        ListFault{"timestamps.txt", "-1 0\n", "timestamps.txt:1: '-1' in column 1 is not a whole number from 0"},
        ListFault{"exposures.txt", "\n0 0 1\n", "exposures.txt:2: column 2 is 0, must be positive"},
        ListFault{"trajectory.txt", "0 0 0 0 0 0 1\n", "trajectory.txt:1 has 7 columns, must have 8"},
        ListFault{"trajectory.txt", "0 0,5 0 0 0 0 0 1\n", "trajectory.txt:1: '0,5' in column 2 is not a number"},
        ListFault{"trajectory.txt", "7 0 0 0 0 0 0 1\n", "trajectory.txt has 1 poses, but none lies within"},
        ListFault{"trajectory.txt", "", "trajectory.txt has 0 poses, but none lies within"}));

TEST(NativeReader, AFolderWithoutPicturesIsAnError) {
    const TemporaryFolder folder;
    write_native(folder / "a", 2);
    fs::remove_all(folder / "a/depth");
    EXPECT_THAT(open_error(folder / "a"), HasSubstr("a/depth is missing, but sequence.json promises 2 frames"));
}

TEST(NativeReader, ADamagedFrameIsSkippedAndTheOthersAreRead) {
    const TemporaryFolder folder;
    const auto damaged = [&](const std::string& name, auto damage) {
        write_native(folder / name, 3);
        damage(folder / name);
        return only_skip_reason(folder / name, 1);
    };
    EXPECT_THAT(damaged("color_missing", [](const fs::path& f) { fs::remove(f / "color/000001.png"); }),
                HasSubstr("color/000001 is missing, as .png, .jpg, .jpeg and .exr"));
    EXPECT_THAT(damaged("color_cut", [](const fs::path& f) { shorten(f / "color/000001.png", 20); }),
                HasSubstr("color/000001.png is truncated"));
    EXPECT_THAT(damaged("depth_cut", [](const fs::path& f) { shorten(f / "depth/000001.png", 20); }),
                HasSubstr("depth/000001.png is truncated"));
    EXPECT_THAT(damaged("size",
                        [](const fs::path& f) {
                            write_png(f / "depth/000001.png", Image<uint16_t>({8, 6}));
                        }),
                HasSubstr("depth/000001.png is 8 x 6 pixels, but the sequence says 16 x 12"));
    EXPECT_THAT(damaged("nan", [](const fs::path& f) { replace_text(f / "trajectory.txt", " 0.1 ", " nan "); }),
                HasSubstr("trajectory.txt:3: column 2 is nan, must be finite"));
}

TEST(NativeReader, ASingleDamagedFirstFrameLeavesTheSequenceUsable) {
    const TemporaryFolder folder;
    write_native(folder / "a", 2);
    write_png(folder / "a/color/000000.png", Image<SrgbPixel>({8, 6}));
    EXPECT_THAT(only_skip_reason(folder / "a", 0), HasSubstr("color/000000.png is 8 x 6 pixels"));
}

TEST(NativeReader, ColourMayBeJpeg) {
    const TemporaryFolder folder;
    write_native(folder / "a", 1);
    fs::remove(folder / "a/color/000000.png");
    write_jpeg(folder / "a/color/000000.jpg", Image<SrgbPixel>({32, 24}, SrgbPixel(90, 90, 90)));
    EXPECT_NEAR(std::get<Image<SrgbPixel>>(frame_at(read_all(*open_sequence(folder / "a")), 0).color).at(3, 3).g, 90,
                2);
}

// 7-Scenes

TEST(SevenScenesReader, ReadsFramesInOrderOfTheirNumbersWithTheKinectsCalibration) {
    const TemporaryFolder folder;
    write_seven_scenes(folder / "seq-01", {15, 17, 1000});
    const auto source = open_sequence(folder / "seq-01");
    const SequenceInfo& info = source->info();
    EXPECT_EQ(info.name, "seq-01");
    EXPECT_EQ(info.format, "7-scenes");
    EXPECT_EQ(info.frames, 3u);
    EXPECT_EQ(info.depth, (Intrinsics{{640, 480}, 585, 585, 320, 240, {}}));
    EXPECT_EQ(info.color, (Intrinsics{{640, 480}, 528, 528, 322.7, 236.8, {}}));
    EXPECT_EQ(info.color_from_depth[3], glm::dvec4(-0.0305, 0.0036, 0, 1));
    const std::vector<Reading> readings = read_all(*source);
    ASSERT_EQ(readings.size(), 3u);
    EXPECT_EQ(frame_at(readings, 1).index, 1u);
    EXPECT_DOUBLE_EQ(frame_at(readings, 1).timestamp_s, 17 / 30.0);
    EXPECT_EQ(units(frame_at(readings, 2)).at(1, 0), 1201);
    EXPECT_DOUBLE_EQ((*frame_at(readings, 2).world_from_camera)[3].x, 0.2);
}

TEST(SevenScenesReader, TheKinectsInvalidDepthBecomesZero) {
    const TemporaryFolder folder;
    write_seven_scenes(folder / "a", {0});
    write_png(folder / "a/frame-000000.depth.png", Image<uint16_t>({640, 480}, 65535));
    EXPECT_EQ(units(frame_at(read_all(*open_sequence(folder / "a")), 0)).at(5, 5), 0);
}

TEST(SevenScenesReader, OtherIntrinsicsMeanARegisteredCamera) {
    const TemporaryFolder folder;
    write_seven_scenes(folder / "a", {0});
    write_text(folder / "a/camera-intrinsics.txt", "570 0 319\n0 571 239\n0 0 1\n");
    const auto source = open_sequence(folder / "a");
    EXPECT_EQ(source->info().depth, (Intrinsics{{640, 480}, 570, 571, 319, 239, {}}));
    EXPECT_EQ(source->info().color, source->info().depth);
    EXPECT_EQ(source->info().color_from_depth, RigidTransform(1.0));

    write_text(folder / "a/camera-intrinsics.txt", "585 0 320\n0 585 240\n0 0 1\n");
    EXPECT_EQ(open_sequence(folder / "a")->info().color.fx, 528);
}

TEST(SevenScenesReader, BadOrMissingIntrinsicsAreErrors) {
    const TemporaryFolder folder;
    write_seven_scenes(folder / "a", {0});
    write_text(folder / "a/camera-intrinsics.txt", "585 0 320\n0 585 240\n");
    EXPECT_THAT(open_error(folder / "a"), HasSubstr("camera-intrinsics.txt has 6 numbers, must have 9"));
    write_text(folder / "a/camera-intrinsics.txt", "585 0 320\n0 -585 240\n0 0 1\n");
    EXPECT_THAT(open_error(folder / "a"), HasSubstr("camera-intrinsics.txt: number 5 is -585, must be positive"));
    write_text(folder / "a/camera-intrinsics.txt", "585 0 nan\n0 585 240\n0 0 1\n");
    EXPECT_THAT(open_error(folder / "a"), HasSubstr("camera-intrinsics.txt: number 3 is nan, must be finite"));
    fs::remove(folder / "a/camera-intrinsics.txt");
    write_png(folder / "a/frame-000000.depth.png", Image<uint16_t>({320, 240}));
    EXPECT_THAT(open_error(folder / "a"),
                HasSubstr("has no camera-intrinsics.txt, and its pictures, 640 x 480 and 320 x 240 pixels"));
}

TEST(SevenScenesReader, ADamagedFrameIsSkippedWithItsFileAndValue) {
    const TemporaryFolder folder;
    const auto damaged = [&](const std::string& name, auto damage) {
        write_seven_scenes(folder / name, {0, 1, 2});
        damage((folder / name / "frame-000001").string());
        return only_skip_reason(folder / name, 1);
    };
    const auto with_pose = [&](const std::string& name, const char* pose) {
        return damaged(name, [&](const std::string& stem) { write_text(stem + ".pose.txt", pose); });
    };
    EXPECT_THAT(with_pose("nan", "1 0 0 0\n0 1 0 nan\n0 0 1 0\n0 0 0 1\n"),
                HasSubstr("frame-000001.pose.txt: row 2, column 4 of the pose is nan, must be finite"));
    EXPECT_THAT(
        with_pose("lost", "-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n"),
        HasSubstr("frame-000001.pose.txt: tracking was lost"));
    EXPECT_THAT(
        with_pose("skewed", "1.1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"),
        HasSubstr(
            "frame-000001.pose.txt: the pose is not rigid, its rotation is off by 0.21, at most 0.01 is accepted"));
    EXPECT_THAT(with_pose("mirrored", "-1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"),
                HasSubstr("frame-000001.pose.txt: the pose mirrors what it moves"));
    EXPECT_THAT(with_pose("transposed", "1 0 0 0\n0 1 0 0\n0 0 1 0\n5 0 0 1\n"),
                HasSubstr("row 4, column 1 of the pose is 5, must be 0"));
    EXPECT_THAT(with_pose("short", "1 0 0 0\n"), HasSubstr("frame-000001.pose.txt has 4 numbers, must have 16"));
    EXPECT_THAT(with_pose("word", "one\n"), HasSubstr("frame-000001.pose.txt:1: 'one' in column 1 is not a number"));
    EXPECT_THAT(damaged("no_pose", [](const std::string& stem) { fs::remove(stem + ".pose.txt"); }),
                HasSubstr("frame-000001.pose.txt does not exist"));
    EXPECT_THAT(damaged("no_color", [](const std::string& stem) { fs::remove(stem + ".color.jpg"); }),
                HasSubstr("frame-000001.color.png does not exist"));
    EXPECT_THAT(damaged("cut", [](const std::string& stem) { shorten(stem + ".color.jpg", 100); }),
                HasSubstr("frame-000001.color.jpg is truncated"));
}

TEST(SevenScenesReader, SmallPoseDefectsAreRepairedAndKept) {
    const TemporaryFolder folder;
    write_seven_scenes(folder / "a", {0});
    write_text(folder / "a/frame-000000.pose.txt", "1.001 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n");
    const auto readings = read_all(*open_sequence(folder / "a"));
    EXPECT_NEAR(frame_at(readings, 0).pose_defect, 0.002001, 1e-12);
    EXPECT_LT(rotation_defect(*frame_at(readings, 0).world_from_camera), 1e-14);
    EXPECT_EQ((*frame_at(readings, 0).world_from_camera)[3], glm::dvec4(1, 2, 3, 1));
}

TEST(SevenScenesReader, WithoutAnyPoseTheSequenceHasNone) {
    const TemporaryFolder folder;
    write_seven_scenes(folder / "a", {0});
    fs::remove(folder / "a/frame-000000.pose.txt");
    const auto source = open_sequence(folder / "a");
    EXPECT_FALSE(source->info().has_poses);
    EXPECT_FALSE(frame_at(read_all(*source), 0).world_from_camera);
}

TEST(SevenScenesReader, ZeroFramesAndNoReadablePictureAreErrors) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "a");
    EXPECT_THAT(open_error(folder / "a", "7-scenes"), HasSubstr("has no frames: no file frame-NNNNNN.depth.png"));
    write_seven_scenes(folder / "b", {0, 1});
    for (const char* name : {"b/frame-000000.depth.png", "b/frame-000001.depth.png"}) shorten(folder / name, 50);
    EXPECT_THAT(open_error(folder / "b"),
                AllOf(HasSubstr("none of 2 pictures can be read"), HasSubstr("frame-000000.depth.png is truncated")));
}

// TUM RGB-D

TEST(TumReader, AssociatesColourAndPosesWithDepth) {
    const TemporaryFolder folder;
    write_tum(folder / "rgbd_dataset_freiburg1_xyz", 3);
    const auto source = open_sequence(folder / "rgbd_dataset_freiburg1_xyz");
    const SequenceInfo& info = source->info();
    EXPECT_EQ(info.format, "tum");
    EXPECT_EQ(info.frames, 3u);
    EXPECT_NEAR(info.fps, 10, 1e-9);
    EXPECT_DOUBLE_EQ(info.metres_per_unit, 0.0002);
    EXPECT_EQ(info.depth, (Intrinsics{{640, 480}, 517.3, 516.5, 318.6, 255.3, {}}));
    EXPECT_EQ(info.color, info.depth);
    const auto readings = read_all(*source);
    EXPECT_DOUBLE_EQ(frame_at(readings, 2).timestamp_s, 10.2);
    EXPECT_EQ((*frame_at(readings, 2).world_from_camera)[3].x, 2);
    EXPECT_EQ(std::get<Image<SrgbPixel>>(frame_at(readings, 2).color).at(0, 0).b, 102);
}

TEST(TumReader, IntrinsicsFollowTheName) {
    const TemporaryFolder folder;
    const auto fx = [&](const std::string& name) {
        write_tum(folder / name, 1);
        return open_sequence(folder / name)->info().depth.fx;
    };
    EXPECT_EQ(fx("freiburg2_desk"), 520.9);
    EXPECT_EQ(fx("fr3/office"), 535.4);
    EXPECT_EQ(fx("mine/desk"), 525);
}

TEST(TumReader, AFrameWithoutColourInTimeIsSkippedAndOneWithoutPoseHasNone) {
    const TemporaryFolder folder;
    write_tum(folder / "a", 3);
    replace_text(folder / "a/rgb.txt", "10.11 ", "10.13 ");
    replace_text(folder / "a/groundtruth.txt", "10.205 ", "10.225 ");
    EXPECT_THAT(only_skip_reason(folder / "a", 1),
                HasSubstr("000001.png has no colour picture within 0.02 s of its timestamp 10.100000"));
    const auto readings = read_all(*open_sequence(folder / "a"));
    EXPECT_TRUE(frame_at(readings, 0).world_from_camera);
    EXPECT_FALSE(frame_at(readings, 2).world_from_camera);
}

TEST(TumReader, BadListsAreErrors) {
    const TemporaryFolder folder;
    write_tum(folder / "a", 2);
    write_text(folder / "a/rgb.txt", "# nothing\n");
    EXPECT_THAT(open_error(folder / "a"), HasSubstr("rgb.txt has no frames: it lists 0 pictures"));
    write_text(folder / "a/rgb.txt", "10 rgb/000000.png extra\n");
    EXPECT_THAT(open_error(folder / "a"), HasSubstr("rgb.txt:1 has 3 columns, must have 2: timestamp path"));
    write_text(folder / "a/rgb.txt", "10 rgb/none.png\n");
    EXPECT_THAT(open_error(folder / "a"), HasSubstr("rgb/none.png does not exist"));
    write_text(folder / "a/rgb.txt", "10 small.png\n");
    write_png(folder / "a/small.png", Image<SrgbPixel>({320, 240}));
    EXPECT_THAT(
        open_error(folder / "a"),
        HasSubstr("holds pictures of 320 x 240 pixels, but TUM RGB-D's intrinsics are known for 640 x 480 only"));
}

TEST(TumReader, ADamagedPictureOrPoseIsSkipped) {
    const TemporaryFolder folder;
    write_tum(folder / "a", 3);
    shorten(folder / "a/depth/000001.png", 30);
    EXPECT_THAT(only_skip_reason(folder / "a", 1), HasSubstr("depth/000001.png is truncated"));
    write_tum(folder / "b", 3);
    replace_text(folder / "b/groundtruth.txt", " 1 0 0 0 0 0 1", " 1 0 0 0 0 0 2");
    EXPECT_THAT(only_skip_reason(folder / "b", 1),
                HasSubstr("groundtruth.txt:3: the pose is not rigid, its rotation is off by 3"));
}

void write_open3d(const fs::path& folder, uint32_t frames) {
    for (const char* pictures : {"color", "depth"}) fs::create_directories(folder / pictures);
    for (uint32_t i = 0; i < frames; ++i) {
        const Frame frame = test_frame(i, {16, 12}, {16, 12});
        write_jpeg(folder / "color" / (picture_stem(2 * i) + ".jpg"), std::get<Image<SrgbPixel>>(frame.color));
        write_png(folder / "depth" / (picture_stem(2 * i) + ".png"), std::get<Image<uint16_t>>(frame.depth));
    }
    write_text(folder / "camera_intrinsic.json",
               R"({"width": 16, "height": 12, "intrinsic_matrix": [14, 0, 0, 0, 13, 0, 7, 6, 1]})");
}

TEST(Open3dReader, PairsPicturesByNameAndReadsTheMatrixByColumns) {
    const TemporaryFolder folder;
    write_open3d(folder / "a", 3);
    const auto source = open_sequence(folder / "a");
    EXPECT_EQ(source->info().format, "open3d");
    EXPECT_EQ(source->info().depth, (Intrinsics{{16, 12}, 14, 13, 7, 6, {}}));
    EXPECT_EQ(source->info().color, source->info().depth);
    EXPECT_FALSE(source->info().has_poses);
    const auto readings = read_all(*source);
    ASSERT_EQ(readings.size(), 3u);
    EXPECT_EQ(std::get<Image<uint16_t>>(frame_at(readings, 2).depth).at(3, 4), 1207);
    fs::remove(folder / "a/color/000002.jpg");
    EXPECT_THAT(only_skip_reason(folder / "a", 1), HasSubstr("color/000002 is missing"));
    write_text(folder / "a/camera_intrinsic.json", R"({"width": 16, "height": 12, "intrinsic_matrix": [14]})");
    EXPECT_THAT(open_error(folder / "a"), HasSubstr("intrinsic_matrix"));
}

}  // namespace
}  // namespace patina::sensor::readers_test
