#include <chrono>

#include <sys/stat.h>

#include "sensor/files/picture_file.h"
#include "tests/cli/run_folder.h"

// Files that are no files, or say of themselves what is not so: one line that names them, and no start that hangs.

namespace patina::testing::hostile_input_test {
namespace {

namespace fs = std::filesystem;
using sensor::testing::read_text;
using sensor::testing::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

void make_pipe(const fs::path& path) {
    fs::remove_all(path);
    ASSERT_EQ(mkfifo(path.c_str(), 0600), 0) << path;
}

class HostileInput : public RunFolderTest {
  protected:
    /// Renders one small frame of a scene, with caches in a folder of the test's own.
    Outcome synth(const std::string& out) {
        return patina({"synth", "cubes", "--frames", "1", "--extent", "16x12", "--no-lighting", "--quiet", "--out",
                       beside(out).string()},
                      {{"XDG_CACHE_HOME", beside("cache").string()}});
    }

    /// The pipeline cache that the first synth() wrote.
    fs::path cache() {
        for (const auto& entry : fs::directory_iterator(beside("cache/patina"))) return entry.path();
        ADD_FAILURE() << "there is no pipeline cache";
        return {};
    }
};

TEST_F(HostileInput, APipelineCacheThatIsNoneIsIgnored) {
    ASSERT_EQ(synth("first").exit_code, 0);
    const fs::path file = cache();
    const std::string whole = read_text(file);
    ASSERT_GT(whole.size(), 16u) << "more than a checksum";
    const auto succeeds = [&](const std::string& what) {
        const Outcome outcome = synth(what);
        EXPECT_EQ(outcome.exit_code, 0) << what << ": " << outcome.err;
        EXPECT_EQ(outcome.err, "") << what;
        EXPECT_EQ(files_in(beside(what)), files_in(beside("first"))) << what;
    };
    make_pipe(file);
    succeeds("pipe");
    fs::remove_all(file);
    fs::create_directories(file / "full");
    succeeds("folder");
    EXPECT_EQ(std::distance(fs::directory_iterator(file.parent_path()), {}), 1) << "nothing is left beside it";
    fs::remove_all(file);
    write_text(file, whole.substr(0, whole.size() / 2));
    succeeds("truncated");
    fs::remove_all(file);
    fs::create_symlink("/dev/zero", file);
    succeeds("device");
}

TEST_F(HostileInput, WhatKilledProcessesLeftBesideAPipelineCacheIsRemoved) {
    ASSERT_EQ(synth("first").exit_code, 0);
    const fs::path file = cache(), folder = file.parent_path();
    const fs::path old = file.string() + ".123", young = file.string() + ".124", other = folder / "pipelines-0.bin.125";
    for (const fs::path& path : {old, young, other}) write_text(path, "half");
    for (const fs::path& path : {old, other})
        fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::hours(48));
    ASSERT_EQ(synth("second").exit_code, 0);
    EXPECT_FALSE(fs::exists(old));
    EXPECT_FALSE(fs::exists(other));
    EXPECT_TRUE(fs::exists(young)) << "another process may still write it";
    EXPECT_TRUE(fs::exists(file));
}

TEST_F(HostileInput, APipeInPlaceOfASettingsOrLightsFileIsAnError) {
    make_pipe(beside("pipe"));
    for (const char* option : {"--lights", "--settings", "--network"}) {
        EXPECT_THAT(expect_failure(patina({"run", sequence(), option, beside("pipe"), "--out", out(), "--quiet"})),
                    HasSubstr(beside("pipe").string() + " is a pipe, not a file"))
            << option;
    }
    EXPECT_THAT(expect_failure(patina({"info", beside("pipe")})), HasSubstr("is a file, but a sequence is a folder"));
}

TEST_F(HostileInput, NestedLightsAreAnError) {
    write_text(beside("deep.json"), std::string(100000, '['));
    EXPECT_THAT(expect_failure(patina({"run", sequence(), "--lights", beside("deep.json"), "--out", out(), "--quiet"})),
                AllOf(HasSubstr("deep.json"), HasSubstr("nests deeper than 64 levels")));
}

TEST_F(HostileInput, ANameThatIsTooLongIsAnError) {
    const std::string longest = beside(std::string(300, 'x')).string();
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{"info", longest},
                                                      {"run", longest, "--out", out()},
                                                      {"lights", longest},
                                                      {"run", sequence(), "--out", out(), "--lights", longest},
                                                      {"eval", longest, longest, "--out", out()}}) {
        EXPECT_THAT(expect_failure(patina(arguments)), AllOf(HasSubstr(longest), Not(HasSubstr("filesystem error"))))
            << arguments[0];
    }
}

// A JPEG whose second frame header has another size made the program abort.
TEST_F(HostileInput, APictureWithTwoHeadersCostsItsFrame) {
    fs::remove(sequence() / "color/000001.png");
    sensor::testing::write_jpeg(sequence() / "color/000001.jpg", Image<SrgbPixel>({32, 24}));
    std::string jpeg = read_text(sequence() / "color/000001.jpg");
    const size_t header = jpeg.find("\xff\xc0");
    ASSERT_NE(header, std::string::npos);
    std::string first = jpeg.substr(header, 2 + size_t{static_cast<uint8_t>(jpeg[header + 3])});
    first[6] = 48;  // rows; the one behind has the sequence's
    write_text(sequence() / "color/000001.jpg", jpeg.insert(header, first));
    const Outcome outcome = patina({"info", sequence()});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("000001.jpg is damaged: it has two frame headers"));
}

}  // namespace
}  // namespace patina::testing::hostile_input_test
