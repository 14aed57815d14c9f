#include "sensor/truth.h"
#include "tests/cli/run_folder.h"

// Each subcommand with memory that is filled when it is handed out and when it is given back: whoever reads what was
// not written, or what was freed, computes with 0xa5a5a5a5. Under the address sanitizer its own options fill instead.

namespace patina::testing::memory_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;

class FilledMemory : public RunFolderTest {
  protected:
    /// Runs `patina` to its end, which must be a result; returns what it printed.
    static std::string run(std::vector<std::string> arguments) {
        const Outcome outcome = patina(arguments, {{"MALLOC_PERTURB_", "165"}});
        EXPECT_EQ(outcome.signal, 0) << arguments[0];
        EXPECT_THAT(outcome.exit_code, AnyOf(0, 3)) << arguments[0] << ": " << outcome.err;
        return outcome.out;
    }
};

TEST_F(FilledMemory, EverySubcommandGivesItsResult) {
    const fs::path recording = beside("recording"), lights = beside("lights.json"), views = beside("views");
    EXPECT_THAT(run({"doctor"}), ::testing::HasSubstr("patina uses device"));
    run({"synth", "cubes", "--frames", "4", "--extent", "64x53", "--truth-every", "2", "--out", recording});
    EXPECT_THAT(run({"info", recording}), ::testing::HasSubstr("4 frames"));
    run({"lights", recording, "--out", lights});
    EXPECT_TRUE(fs::exists(lights));
    run({"run", recording, "--lights", lights, "--dump-every", "1", "--out", out()});
    EXPECT_EQ(summary_of(out())["frames"]["used"], 4);
    run({"eval", recording, out()});
    EXPECT_TRUE(fs::exists(out() / "eval/eval.json"));
    run({"render", recording, "--lights", lights, "--extent", "64x48", "--out", views});
    EXPECT_EQ(files_in(views).size(), 4u);
    run({"synth-hemi", "--examples", "3", "--out", beside("examples.hemi")});
    EXPECT_TRUE(fs::exists(beside("examples.hemi")));
}

}  // namespace
}  // namespace patina::testing::memory_test
