#include <fstream>

#include "sensor/truth.h"
#include "tests/cli/run_folder.h"

// A recording whose low-exposure sequence goes round the scene, in which surfaces light each other.

namespace patina::testing::low_exposure_test {
namespace {

namespace fs = std::filesystem;

class LowExposure : public RunFolderTest {
  protected:
    void record(const std::string& what, int frames, const std::string& extent) {
        const Outcome synth = patina({"synth", what, "--frames", std::to_string(frames), "--extent", extent,
                                      "--samples", "2", "--out", scene(), "--quiet"});
        EXPECT_EQ(synth.exit_code, 0) << synth.err;
    }

    std::string scene() const { return beside("bunnies"); }

    /// run.json of a run that may fall short of materials.
    nlohmann::json run_to(const fs::path& to, std::vector<std::string> more = {}) {
        std::vector<std::string> arguments{"run", scene(), "--out", to, "--texture", "off", "--no-map", "--quiet"};
        for (const char* setting : {"map.voxel_m=0.02", "fusion.truncation_m=0.06"})
            arguments.insert(arguments.end(), {"--set", setting});
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = patina(arguments);
        EXPECT_THAT(outcome.exit_code, ::testing::AnyOf(0, 3)) << outcome.err;
        return summary_of(to);
    }

    static int64_t unseen(const nlohmann::json& summary) {
        return summary["totals"]["vertices that no colour picture saw"];
    }
};

TEST_F(LowExposure, ItIsPartOfTheSurfaceAndOfNoCount) {
    record("bunnies-bounces", 3, "64x53");
    const nlohmann::json with = run_to(out());
    const nlohmann::json without = run_to(beside("without"), {"--lights", scene() + "/truth/lights.json"});
    for (const nlohmann::json& summary : {with, without}) EXPECT_EQ(summary["frames"]["used"], 3);
    EXPECT_EQ(with["lights"]["found_by"], "lighting sequence");
    EXPECT_GT(with["voxel_pool"]["blocks_used"], without["voxel_pool"]["blocks_used"]);
    EXPECT_GT(unseen(with), 10 * unseen(without)) << "the other side of things";
    run_to(beside("again"));
    EXPECT_EQ(files_in(out())["scene.glb"], files_in(beside("again"))["scene.glb"]);
}

TEST_F(LowExposure, FramesWithoutAPoseAreLeftOut) {
    record("bunnies-bounces", 3, "64x53");
    const fs::path trajectory = fs::path(scene()) / "lighting/trajectory.txt";
    std::ifstream in(trajectory);
    std::string first, rest;
    for (std::string line; std::getline(in, line);) (first.empty() && line[0] != '#' ? first : rest) += line + "\n";
    in.close();
    std::ofstream(trajectory) << "0 nan nan nan 0 0 0 1\n" << rest;
    EXPECT_EQ(run_to(out())["frames"]["used"], 3);
}

// Frames of low exposure look down at the cubes, too.
TEST_F(LowExposure, WithoutALampItIsLightAllTheSame) {
    nlohmann::json dark = nlohmann::json::parse(std::ifstream(PATINA_SOURCE_DIR "/assets/scenes/cubes.json"));
    dark["lighting"] = {{"path", dark["path"]}, {"frames", 6}};
    dark["recording"]["bounces"] = 2;
    std::ofstream(beside("dark.json")) << dark.dump();
    const Outcome synth = patina({"synth", beside("dark.json"), "--frames", "6", "--extent", "96x80", "--samples", "2",
                                  "--truth-every", "5", "--out", scene(), "--quiet"});
    ASSERT_EQ(synth.exit_code, 0) << synth.err;
    const auto run = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"run",          scene(),
                                           "--out",        out(),
                                           "--texture",    "off",
                                           "--dump-every", "5",
                                           "--set",        "map.voxel_m=0.02",
                                           "--set",        "fusion.truncation_m=0.06"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return patina(arguments);
    };
    const Outcome outcome = run({});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const nlohmann::json around = summary_of(out());
    EXPECT_EQ(around["lights"]["found_by"], "lighting sequence");
    EXPECT_GT(around["lights"]["ambient"][0], 0);
    EXPECT_EQ(patina({"eval", scene(), out(), "--finished", "--quiet"}).exit_code, 0) << "its map can be resumed";
    const Outcome alone = run({"--set", "reflectance.gathered_rays=0"});
    EXPECT_THAT(alone.out, ::testing::HasSubstr("no lamp was found in the lighting sequence"))
        << "nothing gathers that light";
    EXPECT_EQ(summary_of(out())["lights"]["found_by"], "main sequence");
}

// Frames look down at the floor, and the sky is black at low exposure.
TEST_F(LowExposure, LightThatNoFrameShowsIsTold) {
    record("bunnies-sky", 8, "128x106");
    EXPECT_EQ(run_to(out())["lights"]["ambient"], nlohmann::json({0, 0, 0})) << "the recording says that there is none";
    nlohmann::json recording = nlohmann::json::parse(std::ifstream(scene() + "/sequence.json"));
    ASSERT_EQ(recording.erase("indirect_light"), 1);
    std::ofstream(scene() + "/sequence.json") << recording;
    const nlohmann::json under_sky = run_to(out())["lights"]["ambient"];
    EXPECT_GT(under_sky[0], 0.08) << "0.25 arrives at the floor";
    EXPECT_LT(under_sky[0], 0.35);
    EXPECT_NEAR(sensor::read_ambient(out() / "lights.json").x, under_sky[0], 1e-6);
}

}  // namespace
}  // namespace patina::testing::low_exposure_test
