#include "engine/core/input_file.h"

#include <chrono>
#include <fstream>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "scenes/files/mesh_file.h"
#include "scenes/files/scene_file.h"
#include "sensor/files/json_file.h"
#include "sensor/files/text_file.h"
#include "sensor/open.h"
#include "sensor/truth.h"
#include "tests/sensor/sequences.h"

namespace patina::sensor::input_file_test {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

void make_pipe(const fs::path& path) { ASSERT_EQ(mkfifo(path.c_str(), 0600), 0) << path; }

TEST(InputFile, OnlyRegularFilesAreReadAndNoneIsWaitedFor) {
    const TemporaryFolder folder;
    write_text(folder / "a", "four");
    make_pipe(folder / "pipe");
    fs::create_directory(folder / "folder");
    EXPECT_EQ(read_file(folder / "a", 4).size(), 4u);
    const auto error = [](const fs::path& file) { return error_of([&] { read_file(file, 100); }); };
    EXPECT_EQ(error(folder / "pipe"), (folder / "pipe").string() + " is a pipe, not a file");
    EXPECT_EQ(error(folder / "folder"), (folder / "folder").string() + " is a folder, not a file");
    EXPECT_EQ(error("/dev/zero"), "/dev/zero is a device, not a file");
    EXPECT_EQ(error(folder / "none"), (folder / "none").string() + " does not exist");
    EXPECT_EQ(error(folder / "a/b"), (folder / "a/b").string() + " does not exist");
}

TEST(InputFile, ALongFileIsRefusedBeforeItIsRead) {
    const TemporaryFolder folder;
    write_text(folder / "a", "four");
    EXPECT_EQ(error_of([&] { read_file(folder / "a", 3); }),
              (folder / "a").string() + " has 4 bytes, at most 3 are read");
    fs::resize_file(folder / "a", uint64_t{5} << 30);  // sparse: it takes no place
    EXPECT_THAT(error_of([&] { JsonValue::read(folder / "a"); }), HasSubstr("has 5368709120 bytes, at most 67108864"));
    EXPECT_THAT(error_of([&] { read_lines(folder / "a"); }), HasSubstr("has 5368709120 bytes, at most 67108864"));
    fs::rename(folder / "a", folder / "a.obj");
    EXPECT_THAT(error_of([&] { scenes::read_mesh(folder / "a.obj", {}); }), HasSubstr("has 5368709120 bytes"));
}

TEST(InputFile, WhatCannotBeLookedAtIsAnErrorThatNamesIt) {
    const TemporaryFolder folder;
    const fs::path longest = folder / std::string(300, 'x'), loop = folder / "loop";
    fs::create_symlink("loop", loop);
    EXPECT_EQ(error_of([&] { path_exists(longest); }), longest.string() + " cannot be read: File name too long");
    EXPECT_EQ(error_of([&] { read_file(longest, 9); }), longest.string() + " cannot be read: File name too long");
    EXPECT_THAT(error_of([&] { path_exists(loop); }), HasSubstr(loop.string() + " cannot be read: Too many"));
    EXPECT_THAT(error_of([&] { read_file(loop, 9); }), HasSubstr(loop.string() + " cannot be read: Too many"));
    EXPECT_THAT(error_of([&] { open_sequence(longest); }), HasSubstr("File name too long"));
    EXPECT_FALSE(path_exists(folder / "none"));
    EXPECT_THAT(error_of([&] { entries_of(folder / "none"); }), HasSubstr("none cannot be read: No such file"));
}

TEST(InputFile, EntriesAreInOrder) {
    const TemporaryFolder folder;
    for (const char* name : {"b", "c", "a"}) write_text(folder / name, "");
    EXPECT_THAT(entries_of(folder / ""), ElementsAre(folder / "a", folder / "b", folder / "c"));
}

TEST(InputFile, PicturesThatNoCameraTakesAreRefused) {
    check_picture_size("a", 16384, 8192);
    EXPECT_EQ(error_of([] { check_picture_size("a", 30000, 30000); }),
              "a is 30000 x 30000 pixels, at most 134217728 are decoded");
    EXPECT_EQ(error_of([] { check_picture_size("a", UINT64_MAX, UINT64_MAX); }),
              "a is 18446744073709551615 x 18446744073709551615 pixels, at most 134217728 are decoded");
    EXPECT_THAT(error_of([] { check_picture_size("a", 0, 7); }), HasSubstr("a is 0 x 7 pixels"));
}

// A parser that follows 100 000 levels by recursion overflows the stack.
TEST(InputFile, DeeplyNestedJsonIsRefusedInEveryFile) {
    const TemporaryFolder folder;
    const fs::path file = folder / "a.json";
    const std::string arrays(100000, '['), closed = arrays + std::string(100000, ']');
    for (const std::string& nested : {arrays, closed, "{\"lights\": " + closed + "}"}) {
        write_text(file, nested);
        EXPECT_THAT(error_of([&] { read_lights(file); }),
                    AllOf(HasSubstr(file.string()), HasSubstr("nests deeper than 64 levels")));
        EXPECT_THAT(error_of([&] { scenes::load_scene(file.string()); }), HasSubstr("nests deeper than 64 levels"));
        fs::create_directories(folder / "s");
        write_text(folder / "s/sequence.json", nested);
        EXPECT_THAT(error_of([&] { open_sequence(folder / "s"); }), HasSubstr("nests deeper than 64 levels"));
    }
    std::string text =
        R"({"a": "]]]\"[[[[)" + arrays + R"(", "b": )" + std::string(63, '[') + std::string(63, ']') + "}";
    write_text(file, text);
    EXPECT_TRUE(JsonValue::read(file).at("b").is_array()) << "brackets in a string nest nothing";
}

TEST(InputFile, APipeInPlaceOfAnyInputIsAnError) {
    const TemporaryFolder folder;
    for (const char* name : {"lights.json", "m.obj", "m.ply", "m.glb", "sequence.json"}) make_pipe(folder / name);
    EXPECT_THAT(error_of([&] { read_lights(folder / "lights.json"); }), HasSubstr("is a pipe, not a file"));
    EXPECT_THAT(error_of([&] { scenes::load_scene((folder / "lights.json").string()); }),
                HasSubstr("is a pipe, not a file"));
    for (const char* name : {"m.obj", "m.ply", "m.glb"})
        EXPECT_THAT(error_of([&] { scenes::read_mesh(folder / name, {}); }), HasSubstr("is a pipe, not a file"));
    EXPECT_THAT(error_of([&] { open_sequence(folder / ""); }), HasSubstr("is a pipe, not a file"));
}

TEST(InputFile, AnHourOfLinesIsReadAtOnce) {
    const TemporaryFolder folder;
    std::string lines;
    for (int i = 0; i < 200000; ++i) lines += "1305031102.160407 depth/1305031102.160407.png\n";
    write_text(folder / "depth.txt", lines);
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(read_lines(folder / "depth.txt").size(), 200000u);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

}  // namespace
}  // namespace patina::sensor::input_file_test
