#include "tools/export/output_folder.h"

#include <algorithm>
#include <fstream>
#include <vector>

#include <gmock/gmock.h>

#include "tests/export/temporary_folder.h"
#include "tests/export/throws.h"

namespace patina {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::TemporaryFolder;
using test::throws_error_with;
using testing::ElementsAre;

/// All files below a folder, relative to it, sorted.
std::vector<std::string> files_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
        if (!entry.is_directory()) names.push_back(fs::relative(entry.path(), folder).string());
    }
    std::ranges::sort(names);
    return names;
}

void put(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

TEST(OutputFolder, CreatesMissingParentsAndLeavesNothingBehind) {
    const TemporaryFolder folder;
    { const OutputFolder out(folder / "a/b/c/"); }
    EXPECT_TRUE(fs::is_directory(folder / "a/b/c"));
    EXPECT_THAT(files_in(folder.path()), ElementsAre());
}

TEST(OutputFolder, RefusesAFile) {
    const TemporaryFolder folder;
    put(folder / "taken", "text");
    EXPECT_THAT([&] { OutputFolder out(folder / "taken"); }, throws_error_with("is a file, not a folder"));
    EXPECT_THAT([&] { OutputFolder out(folder / "taken/below"); }, throws_error_with("taken/below"));
    EXPECT_EQ(bytes_of(folder / "taken"), "text");
}

// /proc takes no files, not even from root, who ignores permissions.
TEST(OutputFolder, RefusesWhatCannotBeWrittenTo) {
    EXPECT_THAT([] { OutputFolder out("/proc"); }, throws_error_with("\"/proc\": cannot be written to"));
    EXPECT_THAT([] { OutputFolder out("/proc/patina"); }, throws_error_with("\"/proc/patina\": cannot be created"));
}

TEST(OutputFolder, RemovesAnEarlierRunsMarkAndNothingElse) {
    const TemporaryFolder folder;
    put(folder / "run.json", "{}");
    put(folder / "scene.glb", "old");
    const OutputFolder out(folder.path());
    EXPECT_THAT(files_in(folder.path()), ElementsAre("scene.glb"));
}

TEST(OutputFolder, MarkMayHaveAnotherName) {
    const TemporaryFolder folder;
    put(folder / "run.json", "{}");
    put(folder / "eval.json", "{}");
    const OutputFolder out(folder.path(), "eval.json");
    EXPECT_THAT(files_in(folder.path()), ElementsAre("run.json"));
}

TEST(OutputFolder, WritesBytesAsTheyAre) {
    const TemporaryFolder folder;
    OutputFolder out(folder.path());
    const std::string bytes("a\0\r\n\xff", 5);
    out.write("frames/000012.exr", bytes);
    EXPECT_EQ(bytes_of(folder / "frames/000012.exr"), bytes);
    EXPECT_THAT(files_in(folder.path()), ElementsAre("frames/000012.exr"));
}

TEST(OutputFolder, TheOldFileStaysUntilTheNewOneIsPublished) {
    const TemporaryFolder folder;
    put(folder / "scene.glb", "old");
    OutputFolder out(folder.path());
    const fs::path staged = out.stage("scene.glb");
    EXPECT_EQ(staged.extension(), ".glb");
    put(staged, "new");
    EXPECT_EQ(bytes_of(folder / "scene.glb"), "old");
    out.publish("scene.glb");
    EXPECT_EQ(bytes_of(folder / "scene.glb"), "new");
    EXPECT_THAT(files_in(folder.path()), ElementsAre("scene.glb"));
}

TEST(OutputFolder, WhatWasNotPublishedIsRemovedAtTheEnd) {
    const TemporaryFolder folder;
    {
        OutputFolder out(folder.path());
        put(out.stage("scene.glb"), "half");
        out.write("lights.json", "{}");
        out.stage("never-written.png");
    }
    EXPECT_THAT(files_in(folder.path()), ElementsAre("lights.json"));
}

TEST(OutputFolder, PublishingSaysWhatWentWrong) {
    const TemporaryFolder folder;
    OutputFolder out(folder.path());
    out.stage("scene.glb");
    EXPECT_THAT([&] { out.publish("scene.glb"); }, throws_error_with("scene.glb\": cannot be put in place"));
    fs::create_directories(folder / "run.json/full");
    EXPECT_THAT([&] { out.write("run.json", "{}"); }, throws_error_with("run.json\": cannot be put in place"));
}

TEST(OutputFolderDeathTest, NamesStayInsideTheFolder) {
    const TemporaryFolder folder;
    OutputFolder out(folder.path());
    EXPECT_DEATH(out.stage("../scene.glb"), "plain relative path");
    EXPECT_DEATH(out.stage("/scene.glb"), "plain relative path");
    EXPECT_DEATH(out.publish("scene.glb"), "without being staged");
}

}  // namespace
}  // namespace patina
