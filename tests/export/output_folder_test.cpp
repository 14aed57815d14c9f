#include "tools/report/output_folder.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <optional>
#include <vector>

#include <gmock/gmock.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "sensor/output/new_folder.h"
#include "tests/export/temporary_folder.h"
#include "tests/export/throws.h"
#include "tools/report/swap_folder.h"

namespace patina::output_folder_test {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::TemporaryFolder;
using test::throws_error_with;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kFinished = R"({"format": "patina-run"})";

/// All files below a folder, relative to it, sorted.
std::vector<std::string> files_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_symlink() || !entry.is_directory())
            names.push_back(entry.path().lexically_relative(folder).string());
    }
    std::ranges::sort(names);
    return names;
}

void put(const fs::path& path, const std::string& text) {
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
}

/// Writes results of these names, each holding "new", and puts them in place.
void replace(const fs::path& path, const std::vector<std::string>& names) {
    OutputFolder out(path);
    for (const std::string& name : names) out.write(name, "new");
    out.write("run.json", kFinished);
    out.commit();
}

TEST(OutputFolder, TouchesNothingUntilItIsCommitted) {
    const TemporaryFolder folder;
    { const OutputFolder out(folder / "a/b/c/"); }
    EXPECT_TRUE(fs::is_empty(folder.path())) << "folders above it are gone too";
    put(folder / "out/run.json", kFinished);
    put(folder / "out/scene.glb", "old");
    {
        OutputFolder out(folder / "out");
        out.write("scene.glb", "new");
        out.write("run.json", "new");
        EXPECT_EQ(bytes_of(folder / "out/scene.glb"), "old");
    }
    EXPECT_THAT(files_in(folder.path()), ElementsAre("out/run.json", "out/scene.glb"));
    EXPECT_EQ(bytes_of(folder / "out/scene.glb"), "old");
}

TEST(OutputFolder, CreatesMissingParents) {
    const TemporaryFolder folder;
    const std::string bytes("a\0\r\n\xff", 5);
    OutputFolder out(folder / "a/b/");
    out.write("frames/000012.exr", bytes);
    std::ofstream(out.stage("scene.glb")) << "scene";
    out.publish("scene.glb");
    EXPECT_THAT(out.files(), ElementsAre("frames/000012.exr", "scene.glb"));
    out.commit();
    EXPECT_THAT(files_in(folder.path()), ElementsAre("a/b/frames/000012.exr", "a/b/scene.glb"));
    EXPECT_EQ(bytes_of(folder / "a/b/frames/000012.exr"), bytes);
}

TEST(OutputFolder, NothingOfAnEarlierRunStays) {
    const TemporaryFolder folder;
    const fs::path out = folder / "out";
    for (const char* name : {"scene.glb", "lights.json", "materials.json", "frames/000003.exr", "previews/000003.png",
                             "held_out/scores.txt", "eval/report.html"})
        put(out / name, "old");
    put(out / "run.json", kFinished);
    put(out / "eval/eval.json", R"({"format": "patina-eval"})");
    replace(out, {"scene.glb", "frames/000000.exr"});
    EXPECT_THAT(files_in(folder.path()), ElementsAre("out/frames/000000.exr", "out/run.json", "out/scene.glb"));
    EXPECT_FALSE(fs::exists(out / "previews"));
    EXPECT_EQ(bytes_of(out / "scene.glb"), "new");
}

TEST(OutputFolder, TheUsersFilesStay) {
    const TemporaryFolder folder;
    const fs::path out = folder / "out";
    put(out / "run.json", R"({"format": "patina-run", "files": ["run.json", "scene.glb", "notes.txt", "../beside"]})");
    put(folder / "beside", "mine");
    for (const char* name : {"scene.glb", "frames/000003.exr.txt", "notes.txt", "photos/a/b.jpg", ".hidden"})
        put(out / name, "mine");
    fs::create_symlink("../beside", out / "link");
    ASSERT_EQ(chmod(out.c_str(), 0750), 0);
    replace(out, {"scene.glb", "frames/000000.exr"});
    EXPECT_THAT(files_in(folder.path()),
                ElementsAre("beside", "out/.hidden", "out/frames/000000.exr", "out/frames/000003.exr.txt", "out/link",
                            "out/notes.txt", "out/photos/a/b.jpg", "out/run.json", "out/scene.glb"));
    for (const char* name : {"frames/000003.exr.txt", "notes.txt", "photos/a/b.jpg", ".hidden", "link"})
        EXPECT_EQ(bytes_of(out / name), "mine") << name;
    EXPECT_EQ(bytes_of(out / "scene.glb"), "new");
    EXPECT_EQ(fs::status(out).permissions(), fs::perms(0750));
}

TEST(OutputFolder, RefusesToReplaceWhatPatinaDidNotWrite) {
    for (const char* name : {"lights.json", "frames/000003.exr", "frames", "run.json"}) {
        const TemporaryFolder folder;
        put(folder / "out" / name, "mine");
        EXPECT_THAT([&] { OutputFolder out(folder / "out"); },
                    throws_error_with(text("holds '", name, "', which has the name of a result")));
        EXPECT_THAT(files_in(folder.path()), ElementsAre(text("out/", name)));
    }
    const TemporaryFolder folder;
    put(folder / "out/run.json", R"({"format": "patina-run", "files": ["run.json"]})");
    put(folder / "out/lights.json", "mine");
    EXPECT_THAT([&] { OutputFolder out(folder / "out"); }, throws_error_with("holds 'lights.json'"));
}

TEST(OutputFolder, ResultsThatCannotBePutInPlaceAreKept) {
    const TemporaryFolder folder;
    OutputFolder out(folder / "out");
    out.write("lights.json", "new");
    put(folder / "out/lights.json", "mine, from meanwhile");
    EXPECT_THAT([&] { out.commit(); }, throws_error_with("out-new'"));
    EXPECT_THAT(files_in(folder.path()), ElementsAre("out-new/lights.json", "out/lights.json"));
    EXPECT_EQ(bytes_of(folder / "out-new/lights.json"), "new");
}

/// While it lives, this process can open nothing more.
class NoOpening {
  public:
    NoOpening() {
        getrlimit(RLIMIT_NOFILE, &earlier_);
        const rlimit none{0, earlier_.rlim_max};
        setrlimit(RLIMIT_NOFILE, &none);
    }
    ~NoOpening() { setrlimit(RLIMIT_NOFILE, &earlier_); }
    NoOpening(const NoOpening&) = delete;
    NoOpening& operator=(const NoOpening&) = delete;

  private:
    rlimit earlier_{};
};

TEST(OutputFolder, ResultsThatCannotBeBroughtToTheDiskAreKept) {
    const TemporaryFolder folder;
    put(folder / "out/run.json", kFinished);
    OutputFolder out(folder / "out");
    out.write("lights.json", "new");
    std::string message;
    {
        const NoOpening limit;
        try {
            out.commit();
        } catch (const Error& error) {
            message = error.what();
        }
    }
    EXPECT_THAT(message, HasSubstr("the results are in '" + (folder / "out-new").string()));
    EXPECT_THAT(files_in(folder.path()), ElementsAre("out-new/lights.json", "out/run.json"));
    EXPECT_EQ(fs::status(folder / "out-new").permissions(), fs::status(folder / "out").permissions());
}

TEST(OutputFolder, ResultsWithoutTheirMarkAreKeptBeside) {
    const TemporaryFolder folder;
    put(folder / "out/run.json", kFinished);
    {
        OutputFolder out(folder / "out");
        put(out.stage("run.json"), "half a reco");
        EXPECT_EQ(out.keep(), std::nullopt) << "no result was written";
    }
    {
        OutputFolder out(folder / "out");
        out.write("trajectory.txt", "new");
        put(out.stage("run.json"), "half a reco");
        EXPECT_EQ(out.keep(), fs::canonical(folder.path()) / "out-new");
    }
    EXPECT_THAT(files_in(folder.path()), ElementsAre("out-new/trajectory.txt", "out/run.json"));
}

TEST(OutputFolder, UnfinishedResultsDoNotReplaceFinishedOnes) {
    const TemporaryFolder folder;
    const auto stopped = [&](const char* name) {
        OutputFolder out(folder / name);
        out.write("run.json", R"({"format": "patina-run", "finished": false})");
        return out.commit_unfinished();
    };
    EXPECT_EQ(stopped("new"), folder / "new");
    EXPECT_EQ(stopped("new"), folder / "new") << "unfinished ones replace unfinished ones";
    put(folder / "out/run.json", kFinished);
    put(folder / "out-unfinished/mine", "mine");
    EXPECT_EQ(stopped("out"), fs::canonical(folder.path()) / "out-unfinished-2");
    EXPECT_EQ(stopped("out"), fs::canonical(folder.path()) / "out-unfinished-2");
    EXPECT_THAT(files_in(folder.path()),
                ElementsAre("new/run.json", "out-unfinished-2/run.json", "out-unfinished/mine", "out/run.json"));
    EXPECT_EQ(bytes_of(folder / "out/run.json"), kFinished);
}

TEST(OutputFolder, RefusesInputs) {
    const TemporaryFolder folder;
    put(folder / "data/sequence/trajectory.txt", "poses");
    put(folder / "elsewhere/0.png", "picture");
    fs::create_symlink(folder / "elsewhere", folder / "data/sequence/color");
    fs::create_symlink("data/sequence", folder / "link");
    const auto refused = [&](const char* out, const char* input, const char* relation) {
        EXPECT_THAT([&] { OutputFolder(folder / out, {folder / input}); }, throws_error_with(relation)) << out;
    };
    refused("data/sequence", "data/sequence", "is the input");
    refused("link", "data/sequence", "is the input");
    refused("data/sequence", "link", "is the input");
    refused("link/out", "data/sequence", "lies inside the input");
    refused("data", "link", "holds the input");
    refused("data", "data/sequence/trajectory.txt", "holds the input");
    refused("elsewhere/out", "data/sequence", "color', which");
    EXPECT_NO_THROW(OutputFolder(folder / "data/sequence-out", {folder / "data/sequence"}));
    EXPECT_THAT(files_in(folder.path()),
                ElementsAre("data/sequence/color", "data/sequence/trajectory.txt", "elsewhere/0.png", "link"));
}

TEST(OutputFolder, FollowsALinkToTheFolder) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "disk");
    fs::create_symlink("disk", folder / "out");
    replace(folder / "out", {"scene.glb"});
    EXPECT_TRUE(fs::is_symlink(folder / "out"));
    EXPECT_EQ(bytes_of(folder / "disk/scene.glb"), "new");
    fs::create_symlink("nowhere", folder / "broken");
    EXPECT_THAT([&] { OutputFolder out(folder / "broken"); }, throws_error_with("leads nowhere"));
}

TEST(OutputFolder, RefusesAFile) {
    const TemporaryFolder folder;
    put(folder / "taken", "text");
    EXPECT_THAT([&] { OutputFolder out(folder / "taken"); }, throws_error_with("is a file, not a folder"));
    EXPECT_THAT([&] { OutputFolder out(folder / "taken/below"); }, throws_error_with("taken/below"));
    EXPECT_EQ(bytes_of(folder / "taken"), "text");
}

// /proc takes no files, not even from root, who ignores permissions.
TEST(OutputFolder, RefusesWhatCannotBeExchanged) {
    EXPECT_THAT([] { OutputFolder out("/proc"); }, throws_error_with("is where a disk is mounted"));
    EXPECT_THAT([] { OutputFolder out("/proc/patina"); }, throws_error_with("'/proc' cannot be written to"));
    EXPECT_THAT([] { OutputFolder out("."); }, throws_error_with("that this program was started in"));
    EXPECT_THAT([] { OutputFolder out(".."); }, throws_error_with("that this program was started in"));
}

TEST(OutputFolder, OneWritesAtATime) {
    const TemporaryFolder folder;
    {
        OutputFolder first(folder / "out");
        first.write("scene.glb", "first");
        EXPECT_THAT([&] { OutputFolder out(folder / "out"); },
                    throws_error_with(text("another process is writing '", (folder / "out").string(), "'")));
        EXPECT_NO_THROW(OutputFolder(folder / "other"));
        first.commit();
    }
    EXPECT_THAT(files_in(folder.path()), ElementsAre("out/scene.glb"));
}

TEST(OutputFolder, WhatAKilledRunLeftIsRemoved) {
    const TemporaryFolder folder;
    put(folder / "out/run.json", kFinished);
    put(folder / ".out.patina-partial/frames/000000.exr", "half");
    put(folder / ".out.patina-partial/notes.txt", "the second name of a file in out");
    { const OutputFolder out(folder / "out"); }
    EXPECT_THAT(files_in(folder.path()), ElementsAre("out/run.json"));
}

/// A run that is killed between the exchange and its end leaves the old folder under a hidden name.
TEST(OutputFolder, FilesThatAKilledExchangeTookComeBack) {
    const TemporaryFolder folder;
    put(folder / "out/run.json", kFinished);
    put(folder / ".out.patina-old/run.json", R"({"format": "patina-run"})");
    put(folder / ".out.patina-old/scene.glb", "older");
    put(folder / ".out.patina-old/photos/a.jpg", "mine");
    put(folder / "out/notes.txt", "mine");
    fs::create_hard_link(folder / "out/notes.txt", folder / ".out.patina-old/notes.txt");
    { const OutputFolder out(folder / "out"); }
    EXPECT_THAT(files_in(folder.path()), ElementsAre("out/notes.txt", "out/photos/a.jpg", "out/run.json"));
    EXPECT_EQ(bytes_of(folder / "out/run.json"), kFinished);
}

TEST(OutputFolder, FilesThatAKilledExchangeOfUnfinishedResultsTookComeBack) {
    const TemporaryFolder folder;
    put(folder / "out/run.json", kFinished);
    put(folder / "out-unfinished/run.json", R"({"format": "patina-run", "finished": false})");
    put(folder / ".out-unfinished.patina-old/run.json", R"({"format": "patina-run", "finished": false})");
    put(folder / ".out-unfinished.patina-old/photos/a.jpg", "mine");
    OutputFolder out(folder / "out");
    out.write("run.json", R"({"format": "patina-run", "finished": false})");
    EXPECT_EQ(out.commit_unfinished(), fs::canonical(folder.path()) / "out-unfinished");
    EXPECT_THAT(files_in(folder.path()),
                ElementsAre("out-unfinished/photos/a.jpg", "out-unfinished/run.json", "out/run.json"));
}

TEST(OutputFolder, FilesThatCannotComeBackAreNamedWithTheirPlace) {
    const TemporaryFolder folder;
    put(folder / "out/notes.txt", "mine");
    put(folder / ".out.patina-old/notes.txt", "mine, too");
    EXPECT_THAT([&] { OutputFolder out(folder / "out"); },
                throws_error_with("was being replaced when an earlier run was stopped"));
    EXPECT_THAT([&] { OutputFolder out(folder / "out"); }, throws_error_with(".out.patina-old': "));
    EXPECT_EQ(bytes_of(folder / ".out.patina-old/notes.txt"), "mine, too");
}

/// The Error that `work` throws in a process of its own, once `prepare` has succeeded there; nothing where it has not.
std::optional<std::string> error_in_child(const std::function<bool()>& prepare, const std::function<void()>& work) {
    constexpr int kNotPrepared = 9;
    int ends[2];
    if (pipe(ends) != 0) return std::nullopt;
    const pid_t child = fork();
    if (child == 0) {
        if (!prepare()) _exit(kNotPrepared);
        std::string message;
        try {
            work();
        } catch (const std::exception& error) {
            message = error.what();
        }
        _exit(write(ends[1], message.data(), message.size()) < 0 ? 1 : 0);
    }
    close(ends[1]);
    std::string message(4096, '\0');
    const ssize_t length = read(ends[0], message.data(), message.size());
    close(ends[0]);
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status)) return std::nullopt;
    if (WEXITSTATUS(status) == kNotPrepared) return std::nullopt;
    message.resize(static_cast<size_t>(std::max<ssize_t>(length, 0)));
    return message;
}

TEST(OutputFolder, RefusesAFolderWithAnotherDiskInItAtTheStart) {
    const TemporaryFolder folder;
    put(folder / "out/photos/a.jpg", "mine");
    fs::create_directory(folder / "empty");
    // In a mount namespace of its own, so that no other process sees it.
    const auto mount_at = [](const fs::path& place) {
        return unshare(CLONE_NEWNS) == 0 && mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
               mount("none", place.c_str(), "tmpfs", 0, "size=64k") == 0;
    };
    const auto mounted = [&](const fs::path& place, const std::function<void()>& work) {
        return error_in_child([&] { return mount_at(place); }, work);
    };
    const auto inside = mounted(folder / "out/photos", [&] { OutputFolder out(folder / "out"); });
    if (!inside) GTEST_SKIP() << "no disk can be mounted here";
    EXPECT_THAT(*inside, AllOf(HasSubstr("holds 'photos', where a disk is mounted")));
    const auto at = mounted(folder / "empty", [&] { OutputFolder out(folder / "empty"); });
    EXPECT_THAT(at.value_or(""), HasSubstr("empty' is where a disk is mounted"));
    const auto recording = mounted(folder / "empty", [&] { sensor::NewFolder out(folder / "empty"); });
    EXPECT_THAT(recording.value_or(""), HasSubstr("empty' is where a disk is mounted"));
    EXPECT_THAT(files_in(folder.path()), ElementsAre("out/photos/a.jpg"));
}

TEST(OutputFolder, RefusesAFolderWithOneInItThatCannotBeReadAtTheStart) {
    const TemporaryFolder folder;
    put(folder / "out/a/closed/b", "mine");
    constexpr uid_t kNobody = 65534;
    const auto give_away = [&](const fs::path& path) {
        return geteuid() != 0 || chown(path.c_str(), kNobody, kNobody) == 0;
    };
    for (const char* path : {"", "out", "out/a", "out/a/closed"}) ASSERT_TRUE(give_away(folder / path));
    fs::permissions(folder / "out/a/closed", fs::perms::none);
    const auto message = error_in_child([] { return geteuid() != 0 || setuid(kNobody) == 0; },
                                        [&] { OutputFolder out(folder / "out"); });
    fs::permissions(folder / "out/a/closed", fs::perms::owner_all);
    EXPECT_THAT(message.value_or(""),
                HasSubstr("holds 'a/closed', which cannot be read and written: Permission denied"));
}

/// On file systems that cannot exchange, there is a moment without the folder.
TEST(OutputFolder, AFolderThatAKilledExchangeTookComesBack) {
    const TemporaryFolder folder;
    put(folder / ".out.patina-old/run.json", kFinished);
    put(folder / ".out.patina-old/scene.glb", "old");
    { const OutputFolder out(folder / "out"); }
    EXPECT_THAT(files_in(folder.path()), ElementsAre("out/run.json", "out/scene.glb"));
}

TEST(OutputFolder, RefusesALinkInPlaceOfItsHiddenFolder) {
    const TemporaryFolder folder;
    put(folder / "victim/a", "mine");
    fs::create_directory_symlink("victim", folder / ".out.patina-partial");
    EXPECT_THAT([&] { OutputFolder out(folder / "out"); }, throws_error_with(".out.patina-partial"));
    EXPECT_EQ(bytes_of(folder / "victim/a"), "mine");
}

TEST(OutputFolder, ADigestTellsResultsApart) {
    const TemporaryFolder folder;
    const auto digest = [&](const char* name, const char* bytes, const char* report) {
        OutputFolder out(folder / "out");
        out.write(name, bytes);
        out.write("report.html", report);
        return out.digest();
    };
    EXPECT_EQ(digest("scene.glb", "a", "1 s"), digest("scene.glb", "a", "2 s"));
    EXPECT_NE(digest("scene.glb", "a", "1 s"), digest("scene.glb", "b", "1 s"));
    EXPECT_NE(digest("scene.glb", "a", "1 s"), digest("lights.json", "a", "1 s"));
}

TEST(OutputFolder, PublishingSaysWhatWentWrong) {
    const TemporaryFolder folder;
    OutputFolder out(folder / "out");
    out.stage("scene.glb");
    EXPECT_THAT([&] { out.publish("scene.glb"); }, throws_error_with("scene.glb was not written"));
}

TEST(OutputFolderDeathTest, NamesAreThoseOfResults) {
    const TemporaryFolder folder;
    OutputFolder out(folder / "out");
    EXPECT_DEATH(out.stage("../scene.glb"), "not listed as the name of a result");
    EXPECT_DEATH(out.stage("/scene.glb"), "not listed as the name of a result");
    EXPECT_DEATH(out.stage("frames/../run.json"), "not listed as the name of a result");
    EXPECT_DEATH(out.stage("new.txt"), "not listed as the name of a result");
    EXPECT_DEATH(out.publish("scene.glb"), "without being staged");
}

}  // namespace
}  // namespace patina::output_folder_test
