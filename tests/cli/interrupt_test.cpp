#include <chrono>
#include <csignal>
#include <thread>

#include "sensor/exr_file.h"
#include "tests/cli/run_folder.h"

namespace patina::testing {
namespace {

namespace fs = std::filesystem;
using sensor::testing::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;

class Interrupt : public RunFolderTest {
  protected:
    /// Waits until the run has written a file or ended.
    void await(Program& program, const fs::path& file) {
        while (!fs::exists(file) && program.running()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
};

TEST_F(Interrupt, LeavesWholeFilesOnly) {
    fs::create_directory(out());
    write_text(out() / "scene.glb", "an earlier scene");
    write_text(out() / "run.json", "{}");
    Program program({"run", "synthetic:cubes", "--frames", "100000", "--lighting", "none", "--dump-every", "1", "--out",
                     out(), "--quiet"});
    await(program, out() / "frames/000001.exr");
    program.send(SIGINT);
    EXPECT_THAT(expect_failure(program.wait(), 130),
                AllOf(HasSubstr("interrupted after"), HasSubstr("of 100000 frames")));

    size_t views = 0;
    for (const auto& [name, content] : files_in(out())) {
        if (name == "scene.glb") {
            EXPECT_EQ(content, "an earlier scene");
            continue;
        }
        EXPECT_TRUE(name.starts_with("frames/") && name.ends_with(".exr")) << name;
        EXPECT_EQ(sensor::read_exr_depth(out() / name).extent(), (Extent2D{512, 424})) << name;
        ++views;
    }
    EXPECT_GE(views, 2u);
}

TEST_F(Interrupt, BeforeTheFirstFrameLeavesNothing) {
    Program program({"run", "synthetic:cubes", "--frames", "100000", "--lighting", "none", "--out", out(), "--quiet"});
    await(program, out());
    program.send(SIGTERM);
    expect_failure(program.wait(), 130);
    EXPECT_TRUE(files_in(out()).empty());
}

TEST_F(Interrupt, OfSynthLeavesNothing) {
    // 100000 frames and the 60 of the scene's lighting sequence.
    const fs::path out = beside("parent") / "recording";
    Program program({"synth", "cubes", "--frames", "100000", "--extent", "64x53", "--out", out, "--quiet"});
    await(program, beside("parent"));
    program.send(SIGINT);
    EXPECT_THAT(expect_failure(program.wait(), 130),
                AllOf(HasSubstr("interrupted after"), HasSubstr("of 100060 frames")));
    EXPECT_TRUE(files_in(beside("parent")).empty());
}

}  // namespace
}  // namespace patina::testing
