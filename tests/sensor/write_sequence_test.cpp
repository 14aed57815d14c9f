#include "sensor/write_sequence.h"

#include <cmath>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <unistd.h>

#include "sensor/files/picture_file.h"
#include "sensor/open.h"
#include "tests/sensor/sequences.h"

namespace patina::sensor::write_sequence_test {
namespace {

using namespace testing;
using ::testing::EndsWith;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

size_t entries(const fs::path& folder) {
    return static_cast<size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(SequenceWriter, WhatItWritesReadsBackTheSame) {
    const TemporaryFolder folder;
    SequenceInfo info = test_info();
    info.fps = 12.5;
    info.metres_per_unit = 0.0002;
    info.max_metres = 4;
    info.gravity = glm::dvec3(0.5, 9.75, -1);
    info.color.distortion = {0.1, -0.2, 0.001, 0.002, 0.3};
    info.color_from_depth = glm::translate(RigidTransform(1.0), {0.05, 0.001, -0.002}) *
                            glm::rotate(RigidTransform(1.0), 0.1, glm::dvec3(0, 1, 0));
    std::vector<Reading> written = test_readings(3);
    {
        SequenceWriter writer(folder / "deep/a/", info);
        for (Reading& reading : written) {
            Frame& frame = std::get<Frame>(reading);
            frame.exposure = {0.01 * (1 + frame.index), 2};
            if (frame.index == 1) frame.world_from_camera.reset();
            writer.write(frame);
        }
        writer.finish();
    }
    EXPECT_EQ(entries(folder / "deep"), 1u) << "nothing is left beside the folder";

    const auto source = open_sequence(folder / "deep/a");
    EXPECT_EQ(source->info().name, "test");
    EXPECT_EQ(source->info().fps, 12.5);
    EXPECT_EQ(source->info().color, info.color);
    EXPECT_EQ(source->info().depth, info.depth);
    EXPECT_EQ(source->info().metres_per_unit, 0.0002);
    EXPECT_EQ(source->info().max_metres, 4);
    EXPECT_EQ(source->info().gravity, info.gravity);
    for (int column = 0; column < 4; ++column) {
        EXPECT_LT(glm::distance(source->info().color_from_depth[column], info.color_from_depth[column]), 1e-15);
    }
    const std::vector<Reading> read = read_all(*source);
    ASSERT_EQ(read.size(), written.size());
    for (size_t i = 0; i < read.size(); ++i) {
        const Frame& a = std::get<Frame>(written[i]);
        const Frame& b = std::get<Frame>(read[i]);
        EXPECT_EQ(a.index, b.index);
        EXPECT_EQ(a.timestamp_s, b.timestamp_s);
        EXPECT_EQ(a.exposure, b.exposure);
        EXPECT_EQ(a.world_from_camera, b.world_from_camera);
        EXPECT_EQ(std::get<Image<SrgbPixel>>(a.color).pixels(), std::get<Image<SrgbPixel>>(b.color).pixels());
        EXPECT_EQ(std::get<Image<uint16_t>>(a.depth).pixels(), std::get<Image<uint16_t>>(b.depth).pixels());
    }
}

TEST(SequenceWriter, ListsAreWrittenOnlyWhereTheyVary) {
    const TemporaryFolder folder;
    write_native(folder / "a", 3);
    EXPECT_FALSE(fs::exists(folder / "a/exposures.txt"));
    EXPECT_FALSE(fs::exists(folder / "a/timestamps.txt"));
    EXPECT_TRUE(fs::exists(folder / "a/trajectory.txt"));
}

TEST(SequenceWriter, LinearPixelsAreEncodedAndMetresRounded) {
    const TemporaryFolder folder;
    Frame frame = test_frame(0, {32, 24}, {16, 12});
    Image<glm::vec3> color({32, 24}, glm::vec3(0.0f));
    color.at(0, 0) = {0.2158605f, 1.0f, 7.0f};  // code 128 is linear 0.2158605 (IEC 61966-2-1)
    color.at(1, 0) = {0.0015f, -1.0f, std::nanf("")};
    Image<float> depth_m({16, 12}, 0.0f);
    depth_m.at(0, 0) = 1.2344f;
    depth_m.at(1, 0) = 65.535f;
    depth_m.at(2, 0) = 65.54f;
    depth_m.at(3, 0) = std::numeric_limits<float>::infinity();
    depth_m.at(4, 0) = std::nanf("");
    depth_m.at(5, 0) = -1.0f;
    frame.color = color;
    frame.depth = depth_m;
    SequenceWriter writer(folder / "a", test_info());
    writer.write(frame);
    writer.finish();

    const auto readings = read_all(*open_sequence(folder / "a"));
    const auto& read = std::get<Frame>(readings.at(0));
    EXPECT_EQ(std::get<Image<SrgbPixel>>(read.color).at(0, 0), SrgbPixel(128, 255, 255));
    EXPECT_EQ(std::get<Image<SrgbPixel>>(read.color).at(1, 0), SrgbPixel(5, 0, 0));  // 255 * 12.92 * 0.0015 = 4.9
    const std::vector<uint16_t>& units = std::get<Image<uint16_t>>(read.depth).pixels();
    EXPECT_EQ(std::vector<uint16_t>(units.begin(), units.begin() + 6),
              (std::vector<uint16_t>{1234, 65535, 0, 0, 0, 0}));
}

TEST(SequenceWriter, LinearPixelsAreKeptInExr) {
    const TemporaryFolder folder;
    Frame frame = test_frame(0, {32, 24}, {16, 12});
    Image<glm::vec3> color({32, 24});
    for (size_t i = 0; i < color.pixels().size(); ++i) color.pixels()[i] = glm::vec3(0.1f, 1.0f, 100.0f) * float(i);
    frame.color = color;
    SequenceWriter writer(folder / "a", test_info(), LinearColor::kExr);
    writer.write(frame);
    writer.finish();
    EXPECT_TRUE(fs::exists(folder / "a/color/000000.exr"));
    const auto readings = read_all(*open_sequence(folder / "a"));
    EXPECT_EQ(std::get<Image<glm::vec3>>(std::get<Frame>(readings.at(0)).color).pixels(), color.pixels());
}

TEST(SequenceWriter, AFileThatCannotBeWrittenStopsItAtTheLatestInFinish) {
    const TemporaryFolder folder;
    SequenceWriter writer(folder / "a", test_info());
    fs::remove(writer.partial_folder() / "depth");
    writer.write(test_frame(0, {32, 24}, {16, 12}));
    EXPECT_THAT(error_of([&] { writer.finish(); }), HasSubstr("depth/000000.png"));
    EXPECT_FALSE(fs::exists(folder / "a"));
}

TEST(SequenceWriter, SameFramesGiveSameBytes) {
    const TemporaryFolder folder;
    write_native(folder / "a", 2);
    write_native(folder / "b", 2);
    for (const char* name : {"sequence.json", "trajectory.txt", "color/000001.png", "depth/000001.png"}) {
        EXPECT_EQ(read_text(folder / "a" / name), read_text(folder / "b" / name)) << name;
    }
}

TEST(SequenceWriter, WithoutFinishNothingIsLeft) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "parent");
    {
        SequenceWriter writer(folder / "parent/a", test_info());
        writer.write(test_frame(0, {32, 24}, {16, 12}));
        EXPECT_EQ(writer.partial_folder(), folder / "parent/.a.patina-partial");
        writer.background().finish();
        EXPECT_TRUE(fs::exists(writer.partial_folder() / "color/000000.png"));
        EXPECT_FALSE(fs::exists(folder / "parent/a"));
    }
    EXPECT_TRUE(fs::is_empty(folder / "parent"));
}

TEST(SequenceWriter, RefusesWhatItCannotWrite) {
    const TemporaryFolder folder;
    write_native(folder / "a", 1);
    write_text(folder / "file", "x");
    EXPECT_EQ(error_of([&] { SequenceWriter(folder / "a", test_info()); }),
              (folder / "a").string() + " exists and is not empty; the result is written to a new folder");
    EXPECT_THAT(error_of([&] { SequenceWriter(folder / "file", test_info()); }), HasSubstr("file is a file"));
    EXPECT_THAT(error_of([&] { SequenceWriter(folder / "file/a", test_info()); }), HasSubstr("cannot be written to"));
    fs::create_directory(folder / "empty");
    EXPECT_NO_THROW(SequenceWriter(folder / "empty", test_info()));

    SequenceWriter writer(folder / "b", test_info());
    EXPECT_THAT(error_of([&] { writer.finish(); }), EndsWith("b would have 0 frames; at least 1 must be written"));
    EXPECT_THAT(error_of([&] {
                    writer.write(test_frame(1, {32, 24}, {16, 12}));
                }),
                EndsWith("b: frame 1 was to be written, but 0 is next"));
    EXPECT_THAT(error_of([&] {
                    writer.write(test_frame(0, {8, 6}, {16, 12}));
                }),
                EndsWith("000000: the frame is 8 x 6 pixels, but the sequence 32 x 24"));
}

TEST(SequenceWriter, AFolderFilledMeanwhileIsNotReplaced) {
    const TemporaryFolder folder;
    SequenceWriter writer(folder / "a", test_info());
    writer.write(test_frame(0, {32, 24}, {16, 12}));
    fs::create_directory(folder / "a");
    write_text(folder / "a/mine", "x");
    EXPECT_THAT(error_of([&] { writer.finish(); }), AllOf(HasSubstr("cannot be renamed to"), HasSubstr("a-new'")));
    EXPECT_EQ(read_text(folder / "a/mine"), "x");
    EXPECT_TRUE(fs::exists(folder / "a-new/sequence.json")) << "the recording is kept";
}

}  // namespace
}  // namespace patina::sensor::write_sequence_test
