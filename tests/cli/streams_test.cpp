#include <fmt/format.h>

#include "tests/cli/run_folder.h"

// What a shell does to the standard streams costs no result.

namespace patina::testing::streams_test {
namespace {

namespace fs = std::filesystem;
using sensor::testing::read_text;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class Streams : public RunFolderTest {
  protected:
    /// Runs the recorded frames with these redirections; returns the exit code.
    int run_with(const std::string& redirections) {
        fs::remove_all(out());
        return shell(fmt::format("exec \"$PATINA\" run '{}' --out '{}' --texture off --no-map {}", sequence().string(),
                                 out().string(), redirections));
    }

    void expect_scene() {
        EXPECT_EQ(summary_of(out()).value("frames", nlohmann::json()).value("used", 0), 3);
        EXPECT_EQ(read_text(out() / "scene.glb").substr(0, 4), "glTF");
    }
};

TEST_F(Streams, ProgressThatCannotBePrintedLosesNothing) {
    // A skipped frame is told at once; progress lines come once a second.
    fs::remove(sequence() / "color/000001.png");
    for (const char* redirection : {"2>/dev/full >/dev/null", "2>&- >/dev/null", "2>&1 | head -c 1 >/dev/null"}) {
        run_with(redirection);
        EXPECT_EQ(summary_of(out()).value("frames", nlohmann::json()).value("used", 0), 2) << redirection;
        EXPECT_EQ(read_text(out() / "scene.glb").substr(0, 4), "glTF") << redirection;
    }
}

TEST_F(Streams, ASummaryThatCannotBePrintedIsAFailureThatLosesNothing) {
    const fs::path err = beside("err");
    EXPECT_EQ(run_with(">/dev/full 2>'" + err.string() + "'"), 1);
    // On a slow machine after a line of progress.
    EXPECT_THAT(read_text(err), EndsWith("patina: standard output cannot be written to: No space left on device\n"));
    expect_scene();
    EXPECT_EQ(shell(fmt::format("\"$PATINA\" info '{}' >/dev/full 2>/dev/null", sequence().string())), 1);
    EXPECT_EQ(shell("\"$PATINA\" --help >/dev/full 2>/dev/null"), 1);
}

TEST_F(Streams, AReaderThatHasSeenEnoughIsNoFailure) {
    const fs::path code = beside("code");
    shell(fmt::format("{{ \"$PATINA\" info '{}' 2>&1; echo $? >'{}'; }} | true", sequence().string(), code.string()));
    EXPECT_EQ(read_text(code), "0\n");
}

TEST_F(Streams, ClosedStreamsGetIntoNoFile) {
    EXPECT_EQ(run_with("</dev/null >/dev/null 2>/dev/null"), 0);
    const std::string scene = read_text(out() / "scene.glb"), trajectory = read_text(out() / "trajectory.txt");
    EXPECT_EQ(run_with("<&- >&- 2>&-"), 0);
    expect_scene();
    EXPECT_TRUE(scene == read_text(out() / "scene.glb"));
    EXPECT_TRUE(trajectory == read_text(out() / "trajectory.txt"));
}

TEST_F(Streams, NamesThatAreNotUtf8GetThroughToTheEnd) {
    const fs::path recording = beside("caf\xe9"), results = beside("r\xe9sultats");
    fs::rename(sequence(), recording);
    const std::string text = read_text(recording / "sequence.json");
    const size_t name = text.find("\"name\"");
    ASSERT_NE(name, text.npos);
    // Without a name of its own the sequence has that of its folder.
    sensor::testing::write_text(recording / "sequence.json",
                                text.substr(0, name) + text.substr(text.find('\n', name) + 1));
    const fs::path light = beside("l.json");
    sensor::testing::write_text(light, R"({"lights": [{"position": [0, -2, 0], "intensity": [1, 1, 1]}]})");
    const Outcome outcome = patina({"run", recording, "--out", results, "--lights", light, "--quiet"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(summary_of(results)["sequence"]["name"].get<std::string>(), StartsWith("caf"));
    EXPECT_TRUE(fs::exists(results / "scene.glb"));
}

}  // namespace
}  // namespace patina::testing::streams_test
