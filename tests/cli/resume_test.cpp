#include <csignal>
#include <thread>

#include "tests/cli/run_folder.h"

// Runs that are killed and go on from their map.

namespace patina::testing::resume_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

class Resume : public RunFolderTest {
  protected:
    /// `patina run` of the recording, whose results are what `name` holds then.
    std::vector<std::string> arguments(const std::string& name, const std::string& texture = "off") const {
        return {"run",    sequence(),     "--out", beside(name),         "--set", "map.voxel_m=0.02", "--hold-out",
                "2",      "--dump-every", "1",     "--checkpoint-every", "1",     "--texture",        texture,
                "--quiet"};
    }

    static std::map<std::string, std::string> results_in(const fs::path& folder) {
        std::map<std::string, std::string> files = files_in(folder);
        for (const char* name : {"run.json", "report.html", "map.sqlite"}) files.erase(name);
        return files;
    }
};

TEST_F(Resume, AKilledRunGoesOnToTheSameResults) {
    const Outcome whole = patina(arguments("whole", "auto"));
    ASSERT_EQ(whole.exit_code, 0) << whole.err;
    const fs::path map = beside("killed") / "map.sqlite";
    {
        Program killed(arguments("killed", "auto"));
        while (killed.running() && patina({"info", map}).exit_code != 0)
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        killed.send(SIGKILL);
        ASSERT_EQ(killed.wait().signal, SIGKILL) << "it was at its end already";
    }
    const Outcome info = patina({"info", map});
    EXPECT_EQ(info.exit_code, 0) << info.err;
    EXPECT_THAT(info.out, AllOf(HasSubstr("of 3 read"), HasSubstr("all whole")));
    // A device that the environment names is no argument.
    const Outcome resumed = patina({"run", "--resume", beside("killed"), "--quiet"}, {{"PATINA_DEVICE", "0"}});
    ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
    EXPECT_TRUE(results_in(beside("whole")) == results_in(beside("killed")));
}

TEST_F(Resume, ARecordingIsTakenFurtherThanAtFirst) {
    auto shorter = arguments("short");
    shorter.insert(shorter.end(), {"--frames", "2"});
    ASSERT_EQ(patina(shorter).exit_code, 0);
    auto onwards = arguments("short");
    onwards.insert(onwards.end(), {"--resume", beside("short")});
    const Outcome outcome = patina(onwards);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    ASSERT_EQ(patina(arguments("whole")).exit_code, 0);
    const auto whole = files_in(beside("whole")), longer = files_in(beside("short"));
    for (const char* name : {"scene.glb", "trajectory.txt"}) EXPECT_TRUE(whole.at(name) == longer.at(name)) << name;
}

TEST_F(Resume, AnotherRunExtendsAMapAndLeavesItAsItIs) {
    ASSERT_EQ(patina(arguments("first")).exit_code, 0);
    const auto before = files_in(beside("first"));
    const auto extending = [&](const fs::path& map, const std::string& to, std::vector<std::string> more = {}) {
        std::vector<std::string> words = arguments(to);
        words.insert(words.end(), {"--extend", map.string()});
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    const Outcome outcome = patina(extending(beside("first"), "second"));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_TRUE(files_in(beside("first")) == before);
    EXPECT_THAT(patina({"info", beside("second")}).out, HasSubstr("3 of 3 read"));
    EXPECT_FALSE(files_in(beside("second")).at("scene.glb") == before.at("scene.glb")) << "more frames, less noise";

    EXPECT_THAT(expect_failure(patina(extending(beside("nothing"), "third"))), HasSubstr("there is no map '"));
    EXPECT_THAT(expect_failure(patina(extending("", "third"))), HasSubstr("--extend is empty"));
    EXPECT_THAT(expect_failure(patina(extending(beside("first"), "first"))), HasSubstr("first"));
    EXPECT_THAT(expect_failure(patina(extending(beside("first"), "third", {"--lighting", "none"})), 2),
                HasSubstr("--lighting"));
    EXPECT_TRUE(files_in(beside("first")) == before);
}

TEST_F(Resume, WhatIsMissingIsNamed) {
    EXPECT_THAT(expect_failure(patina({"run", "--resume", beside("nothing")})), HasSubstr("there is no map '"));
    EXPECT_THAT(expect_failure(patina({"run", "--out", out()}), 2), HasSubstr("sequence"));
    EXPECT_THAT(expect_failure(patina({"run", sequence()}), 2), HasSubstr("--out"));
    EXPECT_THAT(expect_failure(patina({"run", "--resume", out(), "--frames", "3"}), 2), HasSubstr("sequence"));
    for (const std::vector<std::string>& more : {std::vector<std::string>{}, {sequence(), "--out", out()}}) {
        std::vector<std::string> words{"run", "--resume", ""};
        words.insert(words.end(), more.begin(), more.end());
        EXPECT_THAT(expect_failure(patina(words)), HasSubstr("--resume is empty"));
    }
}

}  // namespace
}  // namespace patina::testing::resume_test
