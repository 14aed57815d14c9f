#include <algorithm>

#include <nlohmann/json.hpp>

#include "tests/cli/run_folder.h"
#include "tests/eval/eval_rig.h"

// `patina eval` as a user meets it.

namespace patina::testing::eval_test {
namespace {

namespace fs = std::filesystem;
using sensor::testing::read_text;
using sensor::testing::write_text;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Eval : public ::testing::Test {
  protected:
    /// The rig has truth, but no pictures in which surfaces could be counted.
    Outcome eval(std::vector<std::string> more = {}) const {
        std::vector<std::string> arguments{"eval", rig_.sequence(), rig_.run(), "--seen", "1"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return patina(arguments);
    }

    /// eval must fail with one line, which is returned, and leave the run's folder as it was.
    std::string failure() const {
        const auto before = files_in(rig_.run());
        const std::string message = expect_failure(eval({"--quiet"}));
        EXPECT_EQ(files_in(rig_.run()), before);
        EXPECT_FALSE(fs::exists(rig_.run() / "eval"));
        return message;
    }

    const fs::path& sequence() const { return sequence_; }
    const fs::path& run() const { return run_; }

    const test::EvalRig rig_;

  private:
    const fs::path sequence_ = rig_.sequence(), run_ = rig_.run();
};

std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& [name, bytes] : files_in(folder)) names.push_back(name);
    return names;
}

TEST_F(Eval, PrintsTheScoresAndWritesTheReport) {
    const Outcome outcome = eval();
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("S1 floor, S2 box"), HasSubstr("\nkd refined   0.0000 0.0000"),
                                   HasSubstr("\nDepth error     0.00 mm median"), HasSubstr("report.html")));
    EXPECT_THAT(names_in(run() / "eval"), ElementsAre("eval.json", "report.html"));
    const auto json = nlohmann::json::parse(read_text(run() / "eval/eval.json"));
    EXPECT_EQ(json["frames"], (nlohmann::json{0, 10, 20, 30}));
    EXPECT_EQ(json["object_means"]["kd"]["mean"]["filled"]["mad"], 0);
    EXPECT_THAT(read_text(run() / "eval/report.html"), HasSubstr("Error pictures"));
}

TEST_F(Eval, TheSameRunGivesTheSameBytes) {
    eval();
    const auto first = files_in(run() / "eval");
    eval();
    EXPECT_EQ(files_in(run() / "eval"), first);
}

TEST_F(Eval, WritesWhereItIsTold) {
    const Outcome outcome = eval({"--out", run() / "scores", "--quiet"});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.out + outcome.err, "");
    EXPECT_THAT(names_in(run() / "scores"), ElementsAre("eval.json", "report.html"));
    EXPECT_EQ(read_text(run() / "run.json"), "{}") << "a run stays finished";
    EXPECT_FALSE(fs::exists(run() / "eval"));
}

TEST_F(Eval, LightRadiusDecidesAboutMatches) {
    sensor::write_lights(run() / "lights.json", std::vector<Light>{{{0, -2.5, 1.75}, {3, 3, 3}}});
    EXPECT_THAT(eval().out, HasSubstr("0 of 2 matched within 0.50 m"));
    EXPECT_THAT(eval({"--light-radius", "1"}).out, HasSubstr("1 of 2 matched within 1.00 m"));
    EXPECT_THAT(expect_failure(eval({"--light-radius", "0"}), 2), HasSubstr("--light-radius"));
}

TEST_F(Eval, CountingSightingsTakesTheSequencesPictures) {
    EXPECT_THAT(expect_failure(patina({"eval", sequence(), run(), "--quiet"})), HasSubstr(sequence().string()));
    EXPECT_THAT(expect_failure(eval({"--seen", "0"}), 2), HasSubstr("--seen"));
}

TEST_F(Eval, SequenceWithoutTruth) {
    fs::remove_all(sequence() / "truth");
    EXPECT_THAT(failure(), AllOf(HasSubstr("truth/frames"), HasSubstr("--truth-every")));
    fs::remove_all(sequence());
    EXPECT_THAT(failure(), HasSubstr(sequence().string()));
}

TEST_F(Eval, RunWithoutFrames) {
    fs::remove_all(run() / "frames");
    EXPECT_THAT(failure(), AllOf(HasSubstr("frames holds no frames"), HasSubstr("--dump-every")));
    fs::remove_all(run());
    EXPECT_THAT(failure(), HasSubstr(run().string()));
    EXPECT_FALSE(fs::exists(run())) << "a mistyped folder must not be created";
}

TEST_F(Eval, NoFrameInCommon) {
    for (const uint32_t index : {0, 10, 20, 30}) {
        fs::rename(rig_.run_frame(index), rig_.run_frame(index + 5));
    }
    EXPECT_THAT(failure(), HasSubstr("have no frame in common"));
}

TEST_F(Eval, DamagedFrame) {
    fs::resize_file(rig_.run_frame(20), 100);
    EXPECT_THAT(failure(), HasSubstr("000020.exr"));
}

TEST_F(Eval, OutputFolderThatCannotBeWrittenTo) {
    write_text(run() / "eval", "a file");
    EXPECT_THAT(expect_failure(eval({"--quiet"})), AllOf(HasSubstr("output folder"), HasSubstr("is a file")));
    EXPECT_EQ(read_text(run() / "eval"), "a file");
}

class FromSceneToScores : public RunFolderTest {};

TEST_F(FromSceneToScores, GeometryIsReconstructed) {
    const fs::path recording = beside("cubes");
    const Outcome synth = patina({"synth", "cubes", "--frames", "4", "--truth-every", "2", "--extent", "96x80",
                                  "--no-lighting", "--quiet", "--out", recording});
    ASSERT_EQ(synth.exit_code, 0) << synth.err;
    // At this size, pixels are farther apart than the voxels would be by default.
    run_quietly(recording, {"--lighting", "none", "--dump-every", "1", "--set", "map.voxel_m=0.03"});
    EXPECT_THAT(patina({"eval", recording, out()}).out, HasSubstr("No surface was seen in at least 5 frames"));
    const Outcome outcome = patina({"eval", recording, out(), "--seen", "2"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("2 frames of 96 x 80"), HasSubstr("\nDepth error"),
                                   HasSubstr("hold no kd, kd refined, ks, alpha and RGB.")));
    const auto json = nlohmann::json::parse(read_text(out() / "eval/eval.json"));
    EXPECT_EQ(json["frames"], (nlohmann::json{0, 2}));
    EXPECT_EQ(json["seen_frames"], 2);
    EXPECT_GT(json["seen_share"], 0.4);  // nothing in frame 0, nearly everything in frame 2
    EXPECT_LT(json["seen_share"], 0.55);
    EXPECT_LT(json["depth_mm"]["median"], 10);
    EXPECT_GT(json["depth_mm"]["coverage"], 0.8);
    EXPECT_LT(json["trajectory"]["ate_rmse_m"], 1e-6);
    EXPECT_LT(json["object_means"]["rgb"]["mean"]["filled"]["mad"], 0.1);
}

TEST_F(FromSceneToScores, ReflectanceIsEstimatedUnderLightsThatAreFound) {
    const fs::path recording = beside("cubes");
    const Outcome synth = patina({"synth", "cubes", "--frames", "4", "--truth-every", "3", "--extent", "192x160",
                                  "--quiet", "--out", recording});
    ASSERT_EQ(synth.exit_code, 0) << synth.err;
    const auto summary =
        run_quietly(recording, {"--labels", "truth", "--materials", "truth", "--dump-every", "3", "--set",
                                "map.voxel_m=0.01", "--set", "reflectance.voxel_m=0.04", "--texture", "off"});
    EXPECT_EQ(summary["lights"]["found_by"], "lighting sequence");
    ASSERT_EQ(summary["lights"]["lamps"].size(), 3u);
    for (const auto& lamp : summary["lights"]["lamps"]) {
        EXPECT_GE(lamp["sightings"], 5);
        EXPECT_LT(lamp["spread_m"], 0.02);
    }
    const Outcome outcome = patina({"eval", recording, out(), "--seen", "1", "--quiet"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const auto json = nlohmann::json::parse(read_text(out() / "eval/eval.json"));
    EXPECT_LT(json["object_means"]["kd"]["mean"]["filled"]["mad"], 0.1);
    EXPECT_TRUE(json["lights"]["missed"].empty());
    EXPECT_TRUE(json["lights"]["invented"].empty());
}

TEST_F(FromSceneToScores, ViewsThatWereNeverRecordedAreScoredFromTheMapOfARunThatDidNotReadThem) {
    const fs::path recording = beside("cubes"), bare = beside("bare");
    const Outcome synth = patina({"synth", "cubes", "--frames", "4", "--truth-every", "3", "--novel", "2", "--extent",
                                  "192x160", "--quiet", "--out", recording});
    ASSERT_EQ(synth.exit_code, 0) << synth.err;
    for (const char* views : {"novel", "relit"})
        EXPECT_TRUE(fs::exists(recording / "truth" / views / "truth/frames/000001.exr")) << views;
    const std::vector<std::string> options{
        "--dump-every", "3", "--set", "map.voxel_m=0.01", "--set", "reflectance.voxel_m=0.04", "--texture", "off"};
    std::vector<std::string> without_map = options;
    without_map.emplace_back("--no-map");
    run_quietly(recording, without_map);
    EXPECT_THAT(patina({"eval", recording, out()}).out,
                HasSubstr("Note: Views that were never recorded were not compared: the run kept no map"));
    EXPECT_TRUE(nlohmann::json::parse(read_text(out() / "eval/eval.json"))["novel"].is_null());

    run_quietly(recording, options);
    const Outcome outcome = patina({"eval", recording, out(), "--finished"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("\nThe finished model, 2 views:\n"));
    EXPECT_THAT(outcome.out, HasSubstr("\nNever recorded: the same under other lamps, 2 views:\n"));
    const auto json = nlohmann::json::parse(read_text(out() / "eval/eval.json"));
    for (const char* views : {"novel", "relit"}) {
        EXPECT_EQ(json[views]["frames"], (nlohmann::json{0, 1})) << views;
        EXPECT_LT(json[views]["object_means"]["rgb"]["mean"]["filled"]["mad"], 0.1) << views;
        EXPECT_TRUE(fs::exists(out() / "eval" / views / "000001.exr")) << views;
    }
    EXPECT_EQ(json["finished_model"]["frames"], (nlohmann::json{0, 3}));
    // The first frame knew nothing but itself; at the end its view shows what later ones saw, too.
    const auto finished = json["finished_model"]["object_means"]["kd"]["mean"],
               during = json["object_means"]["kd"]["mean"];
    EXPECT_GT(finished["coverage"], during["coverage"]);
    EXPECT_LT(finished["filled"]["mad"], 0.1);
    EXPECT_NE(json["relit"]["object_means"]["rgb"], json["novel"]["object_means"]["rgb"]);
    const std::string there = recording.parent_path().string(), run = fs::relative(out(), there).string();
    EXPECT_EQ(shell("cd '" + there + "' && exec \"$PATINA\" eval cubes '" + run + "' --quiet"), 0)
        << "in place of the one before, by paths from another folder than the run's";

    const auto scene = read_text(out() / "scene.glb");
    fs::copy(recording, bare, fs::copy_options::recursive);
    for (const fs::path& truth : {bare / "truth", bare / "lighting/truth"}) fs::remove_all(truth);
    run_quietly(bare, options);
    EXPECT_EQ(read_text(out() / "scene.glb"), scene) << "a run knows nothing of the truth";
}

class HeldOutFrames : public RunFolderTest {
  protected:
    fs::path recorded() {
        const fs::path recording = beside("cubes");
        const Outcome synth = patina(
            {"synth", "cubes", "--frames", "6", "--extent", "128x106", "--no-lighting", "--quiet", "--out", recording});
        EXPECT_EQ(synth.exit_code, 0) << synth.err;
        return recording;
    }
    const std::vector<std::string> options_{"--hold-out", "3", "--set", "map.voxel_m=0.02", "--texture", "off"};
};

TEST_F(HeldOutFrames, ChangeNothingOfTheScene) {
    const fs::path recording = recorded();
    std::vector<std::string> options = options_;
    options.insert(options.end(),
                   {"--lights", (recording / "truth/lights.json").string(), "--set", "reflectance.voxel_m=0.04"});
    const auto summary = run_quietly(recording, options);
    EXPECT_EQ(summary["held_out"]["pictures"], 2);
    EXPECT_GT(summary["held_out"]["reflectance_own_gain"]["psnr_linear_db"], 10);
    const std::string scene = read_text(out() / "scene.glb");
    // Another view in their place is seen in the scores and nowhere else.
    for (const char* folder : {"color", "depth"}) {
        for (const char* held_out : {"000002.png", "000005.png"})
            fs::copy_file(recording / folder / "000000.png", recording / folder / held_out,
                          fs::copy_options::overwrite_existing);
    }
    const auto changed = run_quietly(recording, options);
    EXPECT_EQ(read_text(out() / "scene.glb"), scene);
    EXPECT_NE(changed["held_out"], summary["held_out"]);
}

TEST_F(HeldOutFrames, AreTrackedWhereTheirPosesAreNotGiven) {
    std::vector<std::string> options = options_;
    options.insert(options.end(), {"--poses", "track", "--lighting", "none"});
    const auto summary = run_quietly(recorded(), options);
    EXPECT_EQ(summary["held_out"]["pictures"], 2);
    EXPECT_GT(summary["held_out"]["mean_color"]["coverage"], 0.4);
    const std::string trajectory = read_text(out() / "trajectory.txt");
    EXPECT_EQ(std::count(trajectory.begin(), trajectory.end(), '\n'), 1 + 4) << trajectory;
}

}  // namespace
}  // namespace patina::testing::eval_test
