#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

#include "tests/cli/run_folder.h"

namespace patina::testing::interrupt_test {
namespace {

namespace fs = std::filesystem;
using sensor::testing::read_text;
using sensor::testing::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class Interrupt : public RunFolderTest {
  protected:
    /// Waits until the run has written its second view somewhere below the test's folder, or has ended.
    void await_frames(Program& program) {
        const auto written = [&] {
            std::error_code gone;  // folders are renamed meanwhile
            for (fs::recursive_directory_iterator entry(beside("."), gone), end; !gone && entry != end;
                 entry.increment(gone))
                if (entry->path().filename() == "000001.exr") return true;
            return false;
        };
        while (!written() && program.running()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }

    /// Sends a second signal when the first one is more than a second old, and the program still where the first one
    /// found it: it is stopped meanwhile.
    void send_late(Program& program, int first, int second) {
        program.send(first);
        std::this_thread::sleep_for(std::chrono::milliseconds(50));  // for the handler
        program.send(SIGSTOP);
        std::this_thread::sleep_for(std::chrono::milliseconds(1200));
        program.send(second);
        program.send(SIGCONT);
    }

    /// With a texture where that is asked for: baking takes longer than all the rest.
    std::vector<std::string> endless(std::vector<std::string> more, bool texture = false) {
        std::vector<std::string> arguments{"run",   small_cubes(), "--frames", "100000",
                                           "--out", out(),         "--detail", "coarse"};
        if (!texture) more.insert(more.end(), {"--texture", "off", "--no-map"});
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }

    /// What an interrupted run has fused is there, and everything says that it is not all.
    void expect_unfinished(const Outcome& outcome, const fs::path& results) {
        EXPECT_EQ(outcome.signal, 0);
        EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
        EXPECT_THAT(outcome.out, StartsWith("incomplete: interrupted after "));
        EXPECT_THAT(outcome.out, HasSubstr("of 100000 frames"));
        const nlohmann::json summary = summary_of(results);
        EXPECT_EQ(summary["finished"], false);
        EXPECT_THAT(summary.value("ended", ""), AllOf(StartsWith("interrupted after "), HasSubstr("of 100000 frames")));
        EXPECT_EQ(summary["shortfalls"][0], summary["ended"]);
        EXPECT_GT(summary["totals"]["triangles"], 10000);
        EXPECT_EQ(read_text(results / "scene.glb").substr(0, 4), "glTF");
        EXPECT_THAT(read_text(results / "report.html"), HasSubstr("interrupted after "));
        const std::string trajectory = read_text(results / "trajectory.txt");
        EXPECT_EQ(std::count(trajectory.begin(), trajectory.end(), '\n'), 1 + summary["frames"]["used"].get<int>());
    }
};

TEST_F(Interrupt, WhatWasFusedIsExtractedAndWritten) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        Program program(endless({"--lighting", "none", "--dump-every", "1"}, signal == SIGINT));
        await_frames(program);
        program.send(signal);
        expect_unfinished(program.wait(), out());
        fs::remove_all(out());
    }
}

TEST_F(Interrupt, AnEarlierRunThatFinishedStays) {
    run_quietly(small_cubes(), {"--frames", "2", "--lighting", "none", "--detail", "coarse", "--texture", "off"});
    const auto earlier = files_in(out());
    EXPECT_TRUE(earlier.contains("map.sqlite"));
    Program program({"run", small_cubes(), "--frames", "100000", "--out", out(), "--detail", "coarse", "--texture",
                     "off", "--lighting", "none", "--dump-every", "1"});
    await_frames(program);
    program.send(SIGINT);
    expect_unfinished(program.wait(), beside("out-unfinished"));
    EXPECT_EQ(files_in(out()), earlier);
}

TEST_F(Interrupt, AfterTheLightsWereFoundItIsStillNoted) {
    Program program(endless({"--dump-every", "1"}));
    await_frames(program);
    program.send(SIGINT);
    expect_unfinished(program.wait(), out());
    EXPECT_TRUE(fs::exists(out() / "materials.json"));
}

TEST_F(Interrupt, TheSecondSignalEndsAtOnce) {
    Program program(endless({"--lighting", "none", "--dump-every", "1"}));
    await_frames(program);
    send_late(program, SIGINT, SIGTERM);
    const Outcome outcome = program.wait();
    EXPECT_EQ(outcome.signal, SIGTERM) << outcome.exit_code;
    EXPECT_FALSE(fs::exists(out() / "run.json"));
}

TEST_F(Interrupt, ASignalThatIsSentTwiceIsOneRequest) {
    // As a terminal does that is closed, and `timeout`.
    for (const int signal : {SIGHUP, SIGTERM}) {
        Program program(endless({"--lighting", "none", "--dump-every", "1"}));
        await_frames(program);
        program.send(signal);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));  // else the two become one
        program.send(signal);
        expect_unfinished(program.wait(), out());
        fs::remove_all(out());
    }
}

TEST_F(Interrupt, ALateHangUpEndsNothing) {
    Program program(endless({"--lighting", "none", "--dump-every", "1"}));
    await_frames(program);
    send_late(program, SIGHUP, SIGHUP);
    expect_unfinished(program.wait(), out());
}

TEST_F(Interrupt, BeforeTheFirstFrameLeavesNothing) {
    // Lamps are looked for in 60 frames first.
    Program program(endless({"--quiet"}));
    program.await_handler(SIGTERM);
    program.send(SIGTERM);
    EXPECT_THAT(expect_failure(program.wait(), 130), HasSubstr("interrupted after"));
    EXPECT_TRUE(files_in(out()).empty());
}

TEST_F(Interrupt, OfSynthLeavesNothing) {
    // 100000 frames and the 60 of the scene's lighting sequence.
    const fs::path out = beside("parent") / "recording";
    Program program({"synth", "cubes", "--frames", "100000", "--extent", "64x53", "--out", out, "--quiet"});
    program.await_handler(SIGINT);
    program.send(SIGINT);
    EXPECT_THAT(expect_failure(program.wait(), 130),
                AllOf(HasSubstr("interrupted after"), HasSubstr("of 100060 frames")));
    EXPECT_TRUE(files_in(beside("parent")).empty());
}

}  // namespace
}  // namespace patina::testing::interrupt_test
