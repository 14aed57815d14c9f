#include <gmock/gmock.h>
#include <sys/fsuid.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/core/error.h"
#include "sensor/files/exr_file.h"
#include "sensor/files/text_file.h"
#include "sensor/output/apart.h"
#include "sensor/output/new_file.h"
#include "sensor/output/new_folder.h"
#include "sensor/output/output_file.h"
#include "tests/sensor/sequences.h"
#include "tests/support/file_size_limit.h"

// How the bytes of results reach the disk.

namespace patina::sensor::output_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::error_of;
using ::testing::HasSubstr;
using testing::read_text;
using testing::TemporaryFolder;
using testing::write_text;

TEST(NewFile, DoesNotWriteThroughLinks) {
    const TemporaryFolder folder;
    for (const char* name : {"linked", "second"}) write_text(folder / name, "mine");
    fs::create_symlink("linked", folder / "a");
    fs::create_hard_link(folder / "second", folder / "b");
    write_bytes(folder / "a", "new");
    write_bytes(folder / "b", "new");
    EXPECT_EQ(read_text(folder / "linked"), "mine");
    EXPECT_EQ(read_text(folder / "second"), "mine");
    EXPECT_EQ(read_text(folder / "a") + read_text(folder / "b"), "newnew");
}

/// A test that fails must not cost the machine its device, which root could remove.
TEST(NewFile, LeavesDevicesAlone) {
    const TemporaryFolder folder;
    const fs::path pipe = folder / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_THAT(error_of([&] { write_bytes(pipe, "x"); }), HasSubstr("a device or the like"));
    EXPECT_THAT(error_of([&] { OutputFile file(pipe); }), HasSubstr("a device or the like"));
    EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(NewFile, SeeksWithinWhatIsWritten) {
    const TemporaryFolder folder;
    NewFile file(folder / "a");
    file.write("0123456789");
    file.seek(2);
    file.write("ab");
    EXPECT_EQ(file.position(), 4u);
    file.close();
    EXPECT_EQ(read_text(folder / "a"), "01ab456789");
}

TEST(NewFile, AFullDiskIsCalledThat) {
    EXPECT_EQ(disk_reason(ENOSPC), "no space is left on the disk");
    EXPECT_THAT(disk_reason(EDQUOT), HasSubstr("share of the disk is used up"));
    const TemporaryFolder folder;
    const Image<glm::vec3> picture({64, 64}, glm::vec3(1, 2, 3));
    std::string of_bytes, of_exr;
    {
        const test::FileSizeLimit limit(100);
        of_bytes = error_of([&] { write_bytes(folder / "a", std::string(150, 'x')); });
        of_exr = error_of([&] { write_exr_color(folder / "b.exr", picture); });
    }
    EXPECT_EQ(of_bytes,
              (folder / "a").string() +
                  " cannot be written: 50 bytes were refused: the file would be larger than files may be here");
    EXPECT_THAT(of_exr, AllOf(HasSubstr("b.exr cannot be written"), HasSubstr("larger than files may be here")));
}

TEST(OutputFile, AppearsWhole) {
    const TemporaryFolder folder;
    write_text(folder / "a.json", "old");
    {
        OutputFile file(folder / "a.json");
        EXPECT_EQ(file.partial_path().extension(), ".json");
        write_bytes(file.partial_path(), "new");
        EXPECT_THAT(error_of([&] { OutputFile(folder / "a.json"); }), HasSubstr("another process is writing"));
        EXPECT_EQ(read_text(folder / "a.json"), "old");
        file.finish();
    }
    EXPECT_EQ(read_text(folder / "a.json"), "new");
    {
        OutputFile file(folder / "b.json");
        write_bytes(file.partial_path(), "half");
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / "."), {}), 1);
}

TEST(OutputFile, SaysWhatItCannotWrite) {
    const TemporaryFolder folder;
    write_text(folder / "a", "mine");
    fs::create_directory(folder / "folder");
    fs::create_hard_link(folder / "a", folder / "b");
    EXPECT_THAT(error_of([&] { OutputFile(folder / "none/a"); }), HasSubstr("there is no folder"));
    EXPECT_THAT(error_of([&] { OutputFile(folder / "folder"); }), HasSubstr("it is a folder"));
    EXPECT_THAT(error_of([&] { OutputFile(folder / "a", {}, OutputFile::Existing::kRefused); }),
                HasSubstr("exists already"));
    EXPECT_THAT(error_of([&] { OutputFile(folder / "b", {folder / "a"}); }), HasSubstr("is the input"));
    EXPECT_THAT(error_of([&] { OutputFile(folder / "folder/a", {folder / "folder"}); }), HasSubstr("lies inside"));
    OutputFile file(folder / "new", {}, OutputFile::Existing::kRefused);
    write_bytes(file.partial_path(), "late");
    write_text(folder / "new", "mine");
    EXPECT_THAT(error_of([&] { file.finish(); }),
                AllOf(HasSubstr("exists already"), HasSubstr("what was written is"), HasSubstr("new-new/new'")));
    EXPECT_EQ(read_text(folder / "new"), "mine");
    EXPECT_EQ(read_text(folder / "new-new/new"), "late");
}

TEST(OutputFile, IsKeptWhereItCannotBePutInPlace) {
    const TemporaryFolder folder;
    {
        OutputFile file(folder / "video.avi");
        write_bytes(file.partial_path(), "hours of work");
        fs::create_directory(folder / "video.avi");
        EXPECT_THAT(error_of([&] { file.finish(); }),
                    AllOf(HasSubstr("cannot be put in place"), HasSubstr("video.avi-new/video.avi'")));
    }
    EXPECT_EQ(read_text(folder / "video.avi-new/video.avi"), "hours of work");
}

/// Makes a folder the working one as long as it lives.
class WorkingFolder {
  public:
    explicit WorkingFolder(const fs::path& folder) { fs::current_path(folder); }
    ~WorkingFolder() {
        std::error_code ignored;
        fs::current_path(earlier_, ignored);
    }
    WorkingFolder(const WorkingFolder&) = delete;
    WorkingFolder& operator=(const WorkingFolder&) = delete;

  private:
    const fs::path earlier_ = fs::current_path();
};

TEST(Resolved, APathThatNamesNothingIsAnError) {
    const TemporaryFolder folder;
    EXPECT_EQ(error_of([] { resolved(""); }), "a path is empty, but must name a file or a folder");
    EXPECT_THAT(error_of([] { NewFolder{fs::path()}; }), HasSubstr("a path is empty"));
    fs::create_directory(folder / "gone");
    const WorkingFolder working(folder / "gone");
    fs::remove(folder / "gone");
    EXPECT_THAT(error_of([] { resolved("out"); }), HasSubstr("'out' leads nowhere"));
    EXPECT_THAT(error_of([] { NewFolder("a/b"); }), HasSubstr("'a/b' leads nowhere"));
    EXPECT_EQ(resolved(folder / "out"), fs::canonical(folder / ".") / "out");
}

TEST(NewFolder, RefusesTheWorkingFolderAtTheStart) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "a");
    {
        const WorkingFolder working(folder / "a");
        EXPECT_THAT(error_of([] { NewFolder("."); }), HasSubstr("that this program was started in"));
    }
    EXPECT_NO_THROW(NewFolder(folder / "a").finish());
}

TEST(NewFolder, WhatCannotBePutInPlaceIsKeptUnderAnotherName) {
    const TemporaryFolder folder;
    for (const std::string kept : {"a-new", "a-new-2"}) {
        fs::remove_all(folder / "a");
        NewFolder result(folder / "a");
        write_text(result.partial_path() / "frame", "work of hours");
        write_text(folder / "a", "mine, from meanwhile");
        EXPECT_THAT(error_of([&] { result.finish(); }),
                    HasSubstr("what was written is in '" + (folder / kept).string()));
        EXPECT_EQ(read_text(folder / kept / "frame"), "work of hours");
        EXPECT_EQ(fs::status(folder / kept).permissions(), fs::status(folder / "a-new").permissions());
    }
    fs::create_directory(folder / "usual");
    EXPECT_EQ(fs::status(folder / "a-new").permissions(), fs::status(folder / "usual").permissions());
    EXPECT_EQ(read_text(folder / "a"), "mine, from meanwhile");
}

TEST(PartialFolder, WhatAnotherUserPutThereIsNotTrusted) {
    const TemporaryFolder folder;
    const fs::path hidden = folder / ".a.patina-partial";
    fs::create_directory(hidden);
    write_text(hidden / "theirs", "x");
    if (chown(hidden.c_str(), 12345, 12345) != 0) GTEST_SKIP() << "only root can give a folder to another user";
    EXPECT_THAT(error_of([&] { NewFolder(folder / "a"); }), HasSubstr("belongs to user 12345, not to this one"));
    EXPECT_EQ(std::distance(fs::directory_iterator(hidden), {}), 1) << "theirs, and no probe";
}

/// As a network's disk that maps all users to one.
TEST(PartialFolder, ADiskThatShowsAllFilesAsAnotherUsersIsWrittenTo) {
    const TemporaryFolder folder;
    fs::permissions(folder / ".", fs::perms::all);
    constexpr uid_t kShown = 12345;
    const auto earlier = static_cast<uid_t>(setfsuid(kShown));
    const bool shown = static_cast<uid_t>(setfsuid(kShown)) == kShown;
    std::string failure;
    try {
        NewFolder(folder / "a").finish();
    } catch (const Error& error) {
        failure = error.what();
    }
    setfsuid(earlier);
    if (!shown) GTEST_SKIP() << "only root can create files as another user";
    EXPECT_EQ(failure, "");
    EXPECT_TRUE(fs::is_directory(folder / "a"));
}

}  // namespace
}  // namespace patina::sensor::output_test
